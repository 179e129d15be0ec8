// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/image_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "lf/light_field/model/image_fit.h"
#include "lf/pixels/files/colour_profile.h"
#include "lf/pixels/files/upright.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// A call of ReadImagePart() or ReadImagePartBytes() for one file.
using ReadPart = std::function<Result<void>(const WantedPixels& wanted, ImagePart* part)>;

ReadPart FromFileAt(const fs::path& path) {
  return [&path](const WantedPixels& wanted, ImagePart* part) {
    return ReadImagePart(path, wanted, part);
  };
}

// Reads at least the pixels `rect` of a file and rotates them if the calibration belongs to the
// rotated picture. `rect` and part->rect, the rectangle that was read, count pixels of the picture
// that the calibration describes.
Result<void> ReadFitting(const ReadPart& read, const std::string& name, bool is_mosaic,
                         const Intrinsics& intrinsics, const PixelRect& rect, ImagePart* part) {
  bool is_turned = false;
  const auto wanted = [&](const ImageFileInfo& info) -> Result<PixelRect> {
    LF_ASSIGN_OR_RETURN(const ImageFit fit, FitToCalibration(info, is_mosaic, intrinsics, name));
    is_turned = fit == ImageFit::kTurned;
    return is_turned ? StoredRect(rect, info.width, info.height, info.orientation) : rect;
  };
  LF_RETURN_IF_ERROR(read(wanted, part));
  if (!is_turned) return {};
  const ImageFileInfo& info = part->info;
  std::visit([&](auto& image) { image = Upright(image, info.orientation); }, part->image);
  part->rect = UprightRect(part->rect, info.width, info.height, info.orientation);
  return {};
}

// Returns kInput for a camera raw file in a light field whose encoding is not that of raw files, or
// states another Bayer pattern. Without this check, the mosaic of the raw file would be shown as a
// grey picture or with wrong colours, or its linear light would be taken for sRGB.
Result<void> CheckRaw(const RawFacts& raw, const RadianceEncoding& encoding,
                      const std::string& name) {
  if (raw.is_monochrome) {
    if (encoding.bayer == BayerPattern::kNone && encoding.transfer != Transfer::kSrgb) return {};
    return InputError(fmt::format(
        "{}: is a camera raw file of a sensor without a colour filter, but the light field {}: use "
        "images of one kind only",
        name,
        encoding.bayer == BayerPattern::kNone ? "consists of sRGB images" : "states lf_bayer"));
  }
  if (encoding.bayer == BayerPattern::kNone)
    return InputError(
        fmt::format("{}: is a camera raw file, but the light field states no lf_bayer: state it, "
                    "or use images of one kind only",
                    name));
  if (raw.bayer != BayerPattern::kNone && raw.bayer != encoding.bayer)
    return InputError(
        fmt::format("{}: has the Bayer pattern {}, but the light field has {}: leave this image "
                    "out, or correct lf_bayer",
                    name, NameOf(raw.bayer), NameOf(encoding.bayer)));
  return {};
}

Result<void> CheckEncoding(const ImagePart& file, const RadianceEncoding& encoding,
                           const std::string& name) {
  if (file.info.raw) LF_RETURN_IF_ERROR(CheckRaw(*file.info.raw, encoding, name));
  if (encoding.bayer != BayerPattern::kNone && file.info.channels != 1)
    return InputError(
        fmt::format("{}: has {} channels, but lf_bayer says that it is a mosaic: expected one "
                    "channel; remove lf_bayer, or use the mosaics",
                    name, file.info.channels));
  if (std::holds_alternative<Image<float>>(file.image)) return {};
  return CheckLevels(encoding, std::holds_alternative<Image<uint8_t>>(file.image) ? 8 : 16, name);
}

const Intrinsics& IntrinsicsOf(const LightField& light_field, LfImageId id) {
  return light_field.intrinsics[light_field.cameras[id.value].intrinsics_index];
}

Result<ChannelUse> ReadPicture(const ReadPart& read, const std::string& name,
                               const LightField& light_field, LfImageId id, const PixelRect& wanted,
                               ImagePart* part) {
  const RadianceEncoding& encoding = light_field.encoding;
  LF_RETURN_IF_ERROR(ReadFitting(read, name, encoding.bayer != BayerPattern::kNone,
                                 IntrinsicsOf(light_field, id), wanted, part));
  LF_RETURN_IF_ERROR(CheckEncoding(*part, encoding, name));
  ConvertColours(encoding, part);
  return UseOf(part->info);
}

}  // namespace

Result<ChannelUse> ReadStoredPixels(const LightField& light_field, LfImageId id,
                                    const PixelRect& wanted, ImagePart* part) {
  const fs::path path = light_field.ImagePath(id);
  return ReadPicture(FromFileAt(path), path.string(), light_field, id, wanted, part);
}

Result<ChannelUse> ReadStoredPixelsOf(std::string_view bytes, const std::string& name,
                                      const LightField& light_field, LfImageId id,
                                      const PixelRect& wanted, ImagePart* part) {
  const auto read = [&](const WantedPixels& of, ImagePart* into) {
    return ReadImagePartBytes(bytes, name, of, into);
  };
  return ReadPicture(read, name, light_field, id, wanted, part);
}

Result<bool> ReadMaskFile(const LightField& light_field, LfImageId id, const PixelRect& wanted,
                          ImagePart* part) {
  if (light_field.mask_names.empty() || light_field.mask_names[id.value].empty()) return false;
  const fs::path path = light_field.folder / light_field.mask_names[id.value];
  LF_RETURN_IF_ERROR(ReadFitting(FromFileAt(path), path.string(), false,
                                 IntrinsicsOf(light_field, id), wanted, part));
  return true;
}

void ForEachSeenBrighter(const LightField& light_field, LfImageId id, const PixelRect& rect,
                         const std::function<void(int x, int y)>& mask) {
  const LfImageId brighter{light_field.cameras[id.value].brighter};
  const RadianceEncoding& encoding = light_field.encoding;
  const Intrinsics& k = IntrinsicsOf(light_field, id);
  const int reach = ReachOfDarker(encoding.bayer);
  const PixelRect around = Intersection(
      {rect.x_begin - reach, rect.y_begin - reach, rect.x_end + reach, rect.y_end + reach},
      {0, 0, k.width_px, k.height_px});
  ImagePart part;
  const Result<ChannelUse> use = ReadStoredPixels(light_field, brighter, around, &part);
  if (!use) return;
  // Marks the pixels whose rays this LF image, the darker one, sends: a square around each pixel
  // that the brighter LF image clips.
  Image<uint8_t> is_left(rect.width(), rect.height(), 1);
  ForEachClipped(part, use->colours, encoding, around, [&](int x, int y) {
    const PixelRect square =
        Intersection({x - reach, y - reach, x + reach + 1, y + reach + 1}, rect);
    for (int row = square.y_begin; row < square.y_end; ++row)
      std::fill_n(&is_left.at(square.x_begin - rect.x_begin, row - rect.y_begin), square.width(),
                  uint8_t{1});
  });
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x)
      if (is_left.at(x - rect.x_begin, y - rect.y_begin) == 0) mask(x, y);
}

void ConvertColours(const RadianceEncoding& encoding, ImagePart* part) {
  if (encoding.transfer == Transfer::kSrgb && encoding.bayer == BayerPattern::kNone)
    ConvertToSrgb(part->icc_profile, &part->image);
}

Result<void> CheckLevels(const RadianceEncoding& encoding, int bits, const std::string& path) {
  if (LevelsFit(encoding, bits)) return {};
  return InputError(fmt::format(
      "{}: contains values of {} bits, but lf_black_level is {} and lf_white_level is "
      "{}: expected a black level below the white level, and a white level of at most {}",
      path, bits, encoding.black_level,
      encoding.white_level ? fmt::format("{}", *encoding.white_level) : "not stated",
      (1 << bits) - 1));
}

}  // namespace lf
