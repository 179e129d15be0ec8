// SPDX-License-Identifier: Apache-2.0
// The command line of `lffocus through`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/frame_options.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/setting_options.h"
#include "tools/focus_frame.h"

namespace lf {

struct ThroughArguments {
  LightFieldArgument light_field;
  FrameArgument frame;             // its `path` is the first of `paths`
  std::vector<std::string> paths;  // PATH, or PACKAGE...
  FrameRangeArguments frames;
  AllowMissing allow_missing;
  std::vector<std::string> outputs;
  PictureArguments picture;
  SettingOptions settings;
  std::string statistic = "median", order = "channels", filter = "auto", lf_pixels = "auto";
  std::string format = "auto", memory = "8G", video;
  double trim = 0.25, max_angle_deg = 0;
  bool overwrite = false, resume = false, no_contact_sheet = false;

  void AddTo(CLI::App& app);
  // Returns true if all of `paths` are packages: files that end in .lfp.
  bool HasPackages() const;
};

}  // namespace lf
