// SPDX-License-Identifier: Apache-2.0
// Writes a synthetic light field, in the words of lfsynth's options.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/synthetic/photograph.h"

namespace lf {

// Each member has the meaning and the default of the option of lfsynth with this name.
struct SyntheticFieldOptions {
  // Frames of the ground truth, instead of the path file `truth`. Their world unit is one metre.
  std::vector<RenderCamera> truth_cameras = {};
  int truth_instants = 1;  // number of consecutive truth_cameras whose mean is one frame
  std::string scene, output, capture = "planar", format = "exr", alpha = "none", truth;
  std::optional<std::pair<int, int>> size_px;
  uint32_t count = 0;
  std::optional<double> spacing, distance;
  double jitter = 0, noise = 0;
  std::vector<double> distortion, fisheye;
  double fov = 0;
  int samples = 0, truth_samples = LensSampling{}.samples;
  bool bayer = false, calibration_only = false, overwrite = false;
  uint64_t seed = 0;
};

// Returns true if the work is to go on. Called after every LF image, and after every frame of the
// ground truth (is_truth), by one thread at a time.
using SyntheticProgress = std::function<bool(size_t done, size_t total, bool is_truth)>;

// Writes the LF images, their calibration and, if a path is given, the ground truth. LF images of
// an earlier light field of lfsynth in the folder are removed, unless calibration_only is true.
// kUsage: options that do not exist or contradict each other; the folder holds a light field, in
// any form, and `overwrite` is false; an output is a file of the path. kInput: the path cannot be
// read. kOutput: the folder or the disk fails. kInterrupted: keep_going() returned false.
Result<void> WriteSyntheticField(const SyntheticFieldOptions& options, ThreadPool& pool,
                                 const SyntheticProgress& keep_going);

}  // namespace lf
