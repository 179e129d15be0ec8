// SPDX-License-Identifier: Apache-2.0
#include "tools/common/light_field_argument.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <utility>

#include "tools/common/help.h"
#include "tools/common/validators.h"

#include "lf/core/shell_word.h"

namespace lf {
namespace {

Result<std::array<double, 3>> ParseBackground(const std::string& text) {
  if (text == "black" || text == kNoBackground) return std::array<double, 3>{0, 0, 0};
  if (text == "white") return std::array<double, 3>{1, 1, 1};
  std::array<double, 3> rgb = {};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (size_t c = 0; c < 3; ++c) {
    const auto [rest, error] = std::from_chars(at, end, rgb[c]);
    const bool is_followed = c == 2 ? rest == end : rest != end && *rest == ',';
    if (error != std::errc() || !is_followed || !(rgb[c] >= 0 && rgb[c] <= 1e6))
      return UsageError(
          fmt::format("--background {}: expected black, white, none, or R,G,B as three numbers "
                      "from 0 to 1e6 in linear light, such as 0.2,0.2,0.3",
                      text));
    at = rest + 1;
  }
  return rgb;
}

void AddUnusualOptions(CLI::App& app, LightFieldArgument& argument) {
  OptionGroup unusual(app, "Unusual light fields");
  unusual
      .Add("--focal-px PIXELS", argument.focal_px,
           "Focal length of the LF cameras (as recorded)\n"
           "In pixels of the LF images. Needed if LIGHTFIELD is a folder of images with Stanford "
           "names (doc/formats/stanford.md) that do not contain the focal length.")
      ->check(CLI::NonNegativeNumber);
  unusual
      .Add("--fov-deg DEGREES", argument.fov_deg,
           "Field of view of the LF cameras (as recorded)\n"
           "Needed for Airborne Optical Sectioning (AOS), whose pose files do not contain it. AOS "
           "images are square, so that one angle is the field of view of the width and of the "
           "height.")
      ->check(CLI::Range(0., 179.));
  unusual.Add(
      "--image-scale FACTOR", argument.image_scale,
      "Size of the image files relative to calibration\n"
      "FACTOR: size of the image files divided by the calibrated size, such as 0.25\n"
      "auto: 1, or the factor of 1/2, 1/3, ... 1/16 that fits all files of up to 64 examined "
      "LF images\n"
      "off: the image files must have the calibrated size");
  unusual.AddChoice(
      "--image-alpha", argument.image_alpha, {"auto", "mask", "straight", "premultiplied"},
      "Meaning of the alpha channel\n"
      "auto: as recorded; if nothing is recorded, found from pixels of the images\n"
      "mask: pixels with an alpha below one half are left out\n"
      "straight, premultiplied: alpha is opacity, and the light of --background shines through");
}

}  // namespace

void LightFieldArgument::AddTo(CLI::App& app) {
  OptionGroup input(app, kInputGroup);
  input
      .Add("LIGHTFIELD", path,
           "Calibration file, its folder, or a packed store\n"
           "The calibration is a transforms.json, or a calibration of COLMAP, Middlebury, LLFF, "
           "HCI or AOS. A packed store is one file, STORE.lfs. A folder of images with Stanford "
           "names is also a light field: the names contain the calibration.")
      ->required()
      ->check(NotEmpty());
  AddOptionsTo(app);
}

void LightFieldArgument::AddOptionsTo(CLI::App& app) {
  OptionGroup input(app, kInputGroup);
  input.Add("--images DIR", images,
            "Folder of the LF images, if they were moved\n"
            "Needed if the image files are not where the calibration says. Each image file is "
            "searched by its name in DIR and all folders below it. The extension of the name, "
            "such as .png, may differ.");
  input
      .Add("--background COLOUR", background,
           "Light behind LF images with alpha\n"
           "Used if the alpha channel of the LF images is opacity (--image-alpha straight or "
           "premultiplied). If the option is not given, the background is the one that the "
           "calibration states; if it states none, the colour of the transparent pixels if the "
           "meaning of alpha was found from them, otherwise black.\n"
           "COLOUR: black, white, or R,G,B in linear light, where 1 is display white\n"
           "none: frames get an alpha channel; their colours are those in front of black")
      ->check(NotEmpty())
      ->default_str("as recorded, else black");
  AddUnusualOptions(app, *this);
}

Result<OpenOptions> LightFieldArgument::Options() const {
  OpenOptions options;
  options.alpha = AlphaMeaningOf(image_alpha);
  if (!background.empty()) {
    LF_ASSIGN_OR_RETURN(options.background, ParseBackground(background));
    options.keeps_opacity = background == kNoBackground;
  }
  LF_ASSIGN_OR_RETURN(options.image_scale, ParseImageScale(image_scale));
  if (focal_px > 0) options.focal_px = focal_px;
  if (fov_deg > 0) options.fov_deg = fov_deg;
  if (!images.empty()) options.images_folder = images;
  return options;
}

Result<void> LightFieldArgument::CheckWithPackages() const {
  if (image_alpha != "auto" || !background.empty())
    return UsageError(
        "--image-alpha and --background cannot be used with packages, which contain the values of "
        "these options that lfpreprocessor was given: leave the options out, or give them to "
        "lfpreprocessor and make the packages again");
  if (!path.empty() || Words().empty()) return {};
  return UsageError(fmt::format(
      "{} cannot be used with packages, which contain the calibration: leave it out; if the LF "
      "images were moved, give their light field with --lightfield",
      Words()[0]));
}

Result<LightField> LightFieldArgument::Open() const {
  LF_ASSIGN_OR_RETURN(const OpenOptions options, Options());
  return OpenLightField(path, options);
}

std::vector<std::string> LightFieldArgument::Words() const {
  std::vector<std::string> words;
  if (focal_px > 0) words.insert(words.end(), {"--focal-px", fmt::format("{}", focal_px)});
  if (fov_deg > 0) words.insert(words.end(), {"--fov-deg", fmt::format("{}", fov_deg)});
  if (!images.empty()) words.insert(words.end(), {"--images", FileArgument(images)});
  if (image_scale != "auto") words.insert(words.end(), {"--image-scale", image_scale});
  if (image_alpha != "auto") words.insert(words.end(), {"--image-alpha", image_alpha});
  if (!background.empty()) words.insert(words.end(), {"--background", background});
  return words;
}

std::vector<std::string> LightFieldArgument::WordsToKeep() const {
  LightFieldArgument kept = *this;
  if (!images.empty()) kept.images = std::filesystem::absolute(images).lexically_normal().string();
  return kept.Words();
}

Result<LightFieldArgument> LightFieldArgument::Of(std::string path,
                                                  const std::vector<std::string>& words) {
  LightFieldArgument argument;
  CLI::App app;
  argument.AddOptionsTo(app);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // the last word comes first
  } catch (const CLI::Error& error) {
    return InputError(
        fmt::format("the options of {} cannot be read again: {}", path, error.what()));
  }
  argument.path = std::move(path);
  return argument;
}

}  // namespace lf
