#include "tools/common/light_field_argument.h"

#include <fmt/format.h>

namespace lf {

void LightFieldArgument::AddTo(CLI::App& app) {
  app.add_option("LIGHTFIELD", path,
                 "A calibration file, or its folder: transforms.json, COLMAP, Middlebury, LLFF, "
                 "AOS; a packed store (STORE.lfs); or a folder of images with Stanford names")
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
                 "Folder of the image files, for COLMAP models and AOS poses that lie elsewhere");
}

OpenOptions LightFieldArgument::Options() const {
  OpenOptions options;
  if (focal_px > 0) options.focal_px = focal_px;
  if (fov_deg > 0) options.fov_deg = fov_deg;
  if (!images.empty()) options.images_folder = images;
  return options;
}

Result<LightField> LightFieldArgument::Open() const { return OpenLightField(path, Options()); }

std::vector<std::string> LightFieldArgument::Words() const {
  std::vector<std::string> words;
  if (focal_px > 0) words.insert(words.end(), {"--focal-px", fmt::format("{}", focal_px)});
  if (fov_deg > 0) words.insert(words.end(), {"--fov-deg", fmt::format("{}", fov_deg)});
  if (!images.empty()) words.insert(words.end(), {"--images", images});
  return words;
}

}  // namespace lf
