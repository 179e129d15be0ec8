#include "tools/common/light_field_argument.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "tools/common/program.h"

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
          fmt::format("--background {}: expected black, white, none, or three radiances from 0 on "
                      "such as 0.2,0.2,0.3",
                      text));
    at = rest + 1;
  }
  return rgb;
}

}  // namespace

void LightFieldArgument::AddTo(CLI::App& app) {
  app.add_option("LIGHTFIELD", path,
                 "A calibration file, or its folder: transforms.json, COLMAP, Middlebury, LLFF, "
                 "HCI, AOS; a packed store (STORE.lfs); or a folder of images with Stanford names")
      ->required();
  AddOptionsTo(app);
}

void LightFieldArgument::AddOptionsTo(CLI::App& app) {
  app.add_option("--focal-px", focal_px,
                 "Focal length in pixels, for Stanford folders whose names do not tell it; 0: as "
                 "recorded")
      ->check(CLI::NonNegativeNumber);
  app.add_option(
         "--fov-deg", fov_deg,
         "Field of view in degrees, for poses of Airborne Optical Sectioning; 0: as recorded")
      ->check(CLI::Range(0., 179.));
  app.add_option("--images", images,
                 "Folder of the image files, if they are not where the calibration says: each is "
                 "found by its name, whatever its suffix and the folders below");
  app.add_option("--image-scale", image_scale,
                 "Size of the image files beside the calibrated one: a factor such as 0.25; auto: "
                 "1, or 1/2 to 1/16 if all have it; off: as calibrated");
  app.add_option("--image-alpha", image_alpha,
                 "What the alpha of images means: mask (below one half nothing was recorded), "
                 "straight or premultiplied light over --background; auto: as recorded, or as "
                 "their pixels tell")
      ->check(CLI::IsMember({"auto", "mask", "straight", "premultiplied"}));
  app.add_option(
         "--background", background,
         "Light behind images whose alpha is light: black, white, or R,G,B, linear, where 1 "
         "is display white; none: frames have alpha themselves, and light as over black")
      ->check(NotEmpty())
      ->default_str("as recorded, or black");
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
        "--image-alpha and --background: packages have what they were made with: leave them out, "
        "or "
        "make the packages again by lfpreprocessor with them");
  if (!path.empty() || Words().empty()) return {};
  return UsageError(fmt::format(
      "{} is for a light field: packages have their calibration; if the images have moved, "
      "--lightfield says where it is now",
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
  if (!images.empty()) words.insert(words.end(), {"--images", images});
  if (image_scale != "auto") words.insert(words.end(), {"--image-scale", image_scale});
  if (image_alpha != "auto") words.insert(words.end(), {"--image-alpha", image_alpha});
  if (!background.empty()) words.insert(words.end(), {"--background", background});
  return words;
}

}  // namespace lf
