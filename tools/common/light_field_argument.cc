#include "tools/common/light_field_argument.h"

namespace lf {

void LightFieldArgument::AddTo(CLI::App& app) {
  app.add_option("LIGHTFIELD", path,
                 "transforms.json, its folder, or a folder of images in Stanford order")
      ->required();
  app.add_option("--focal-px", focal_px,
                 "Focal length in pixels, for Stanford folders whose names do not tell it; 0: as "
                 "recorded")
      ->check(CLI::NonNegativeNumber);
}

Result<LightField> LightFieldArgument::Open() const {
  OpenOptions options;
  if (focal_px > 0) options.focal_px = focal_px;
  return OpenLightField(path, options);
}

}  // namespace lf
