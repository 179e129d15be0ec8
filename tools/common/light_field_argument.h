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
  std::string images;

  // The positional argument and the options that go with it.
  void AddTo(CLI::App& app);
  // The options alone.
  void AddOptionsTo(CLI::App& app);
  OpenOptions Options() const;
  Result<LightField> Open() const;
  // The options as they were given, for another program.
  std::vector<std::string> Words() const;
};

}  // namespace lf
