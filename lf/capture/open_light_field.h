// Any supported calibration as a LightField: every program takes its LIGHTFIELD through this.
#pragma once

#include <filesystem>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

// Reads what `path` is: a transforms.json, a folder holding one, or a folder of images in
// Stanford order (capture/read_stanford.h). No pixels are read; that image files exist is not
// checked here.
// kInput: nothing there that is a light field (the message lists what was looked for), or the
// reader's own error.
Result<LightField> OpenLightField(const std::filesystem::path& path);

}  // namespace lf
