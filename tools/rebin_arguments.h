// SPDX-License-Identifier: Apache-2.0
// The options of lfrenderer for rebinned rays (doc/rebinning.md).
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/render/hybrid/rebinned_rays.h"

namespace lf {

struct RebinArguments {
  int nearest = 0;
  std::string kept = "auto", preview = "auto", average_others = "off", reparameterise = "on";
  RebinSettings options;  // the options that are parsed directly; Make() sets the others
  std::string max_rays = "0";
  double r_st_w = 0, r_uv_w = 0, slab_distance_w = 0;
  std::vector<double> slab_position_w, slab_forward;

  void AddTo(CLI::App& app);
  // Converts the arguments to options. kUsage if a value is impossible, or if values contradict
  // each other.
  Result<RebinSettings> Make() const;
};

}  // namespace lf
