// LIGHTFIELD, as every program takes it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lf/calibration/open_light_field.h"

namespace lf {

struct LightFieldArgument {
  std::string path;
  double focal_px = 0;
  double fov_deg = 0;
  std::string images, image_scale = "auto", image_alpha = "auto", background;

  // The positional argument and the options that go with it.
  void AddTo(CLI::App& app);
  // The options alone.
  void AddOptionsTo(CLI::App& app);
  // kUsage: a value that cannot be read.
  Result<OpenOptions> Options() const;
  Result<LightField> Open() const;
  // kUsage: an option is given that packages would ignore. Packages have their calibration, and
  // what alpha means; with --lightfield (`path`) the others say how that is opened.
  Result<void> CheckWithPackages() const;
  // The options as they were given, for another program.
  std::vector<std::string> Words() const;
};

}  // namespace lf
