// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/raw_encoding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>

#include "lf/core/log.h"

namespace lf {

bool IsRawName(const std::string& file_name) {
  constexpr std::string_view kExtensions[] = {
      ".dng", ".nef", ".nrw", ".arw", ".sr2", ".pef", ".cr2", ".cr3", ".crw", ".raf",
      ".orf", ".rw2", ".rwl", ".mrw", ".srw", ".3fr", ".erf", ".mef", ".iiq", ".x3f"};
  std::string extension = std::filesystem::path(file_name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) !=
         std::end(kExtensions);
}

Result<std::optional<RawFacts>> RawFactsOfFirstImage(const LightField& light_field) {
  constexpr const char* kAdvice =
      "repair or remove this image, or state lf_bayer, lf_black_level, lf_white_level, "
      "lf_white_balance and lf_camera_to_srgb in a transforms.json";
  if (light_field.image_names.empty() || !IsRawName(light_field.image_names[0]))
    return std::optional<RawFacts>();
  Result<ImageFileInfo> info = ReadImageInfo(light_field.ImagePath({0}));
  if (info && info->raw && !info->raw->black_level) {
    Result<ImageWithInfo> image = ReadImageWithInfo(light_field.ImagePath({0}));
    info = image ? Result<ImageFileInfo>(std::move(image->info)) : image.error();
  }
  if (!info)
    return InputError(
        fmt::format("{}; the first camera raw file must state the Bayer pattern, levels and "
                    "colours of all LF images: {}",
                    info.error().message, kAdvice));
  if (!info->raw)
    return InputError(
        fmt::format("{}: has the name of a camera raw file, but is another kind of file: {}",
                    light_field.ImagePath({0}).string(), kAdvice));
  return info->raw;
}

RadianceEncoding EncodingOfRaw(const RawFacts& facts) {
  RadianceEncoding encoding;
  encoding.bayer = facts.bayer;
  encoding.transfer = Transfer::kLinear;
  encoding.black_level = facts.black_level.value_or(0);
  encoding.white_level = facts.white_level;
  encoding.pedestal = encoding.black_level > 0 ? kRawPedestal : 0;
  if (facts.white_balance) encoding.white_balance = *facts.white_balance;
  if (facts.linear_srgb_from_camera)
    encoding.linear_srgb_from_camera = *facts.linear_srgb_from_camera;
  return encoding;
}

Result<void> CompleteEncodingOfRaw(LightField* light_field) {
  LF_ASSIGN_OR_RETURN(const std::optional<RawFacts> facts, RawFactsOfFirstImage(*light_field));
  if (!facts) return {};
  const double max_radiance = light_field->encoding.max_radiance;
  light_field->encoding = EncodingOfRaw(*facts);
  light_field->encoding.max_radiance = max_radiance;
  WarnOfUnknown(*light_field, *facts, false, false);
  return {};
}

void WarnOfUnknown(const LightField& light_field, const RawFacts& facts, bool levels_stated,
                   bool colours_stated) {
  const std::string name = light_field.ImagePath({0}).string();
  if (!levels_stated && !(facts.black_level && facts.white_level))
    LogWarning(
        "{}: this camera raw file does not state its {}; assumed to be {}: if this is wrong, state "
        "lf_black_level and lf_white_level in transforms.json",
        name, facts.black_level ? "white level" : "black and white level",
        facts.black_level ? "65535" : "0 and 65535");
  if (!colours_stated && !facts.is_monochrome &&
      !(facts.white_balance && facts.linear_srgb_from_camera))
    LogWarning(
        "{}: this camera raw file does not state its {}; colours stay those of the sensor: to "
        "correct them, state lf_white_balance and lf_camera_to_srgb in transforms.json",
        name,
        facts.white_balance             ? "colour matrix"
        : facts.linear_srgb_from_camera ? "white balance"
                                        : "white balance and colour matrix");
}

}  // namespace lf
