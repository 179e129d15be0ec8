// Any supported calibration as a LightField: every program takes its LIGHTFIELD through this.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

struct OpenOptions {
  // What folders of the Stanford form may lack: StanfordOptions of capture/read_stanford.h, and
  // kUsage elsewhere. All but the first are offered by lfimport alone.
  std::optional<double> focal_px = {};
  std::optional<Vec2> pitch_w = {};
  std::optional<double> plane_distance_w = {};
  bool flip_x = false;
  bool flip_y = false;
};

// Reads what `path` is: a transforms.json (any .json file), a folder holding one, or a folder of
// images with names of the Stanford form (capture/read_stanford.h), in it or in its images/. No
// pixels are read; that image files exist is not checked here.
// kInput: nothing there that is a light field (the message lists what was looked for), or the
// reader's own error.
Result<LightField> OpenLightField(const std::filesystem::path& path,
                                  const OpenOptions& options = {});

}  // namespace lf
