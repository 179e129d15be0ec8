// SPDX-License-Identifier: Apache-2.0
// Writes a synthetic light field with its ground truth, in the words of lfsynth's options.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
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

// Members without a comment have the meaning and the default of the option of lfsynth with this
// name.
struct SyntheticFieldOptions {
  std::vector<RenderCamera> truth_cameras = {};  // of the ground truth; the world unit is one metre
  uint32_t first_truth_frame = 1;                // number of the first frame of the ground truth
  int truth_instants = 1;  // number of consecutive truth_cameras whose mean is one frame
  // Files that are read, such as those of a camera path, and that no output may replace.
  std::vector<std::filesystem::path> inputs = {};
  // Returns true for a folder that holds a light field in any form (HoldsLightField(),
  // import/formats/open_light_field.h). Unset: only a transforms.json counts.
  std::function<bool(const std::filesystem::path&)> holds_light_field = {};
  std::string scene, output, capture = "planar", format = "exr", alpha = "none";
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

// Writes the LF images, their calibration and, if there are truth_cameras, the ground truth. LF
// images of an earlier light field of lfsynth in the folder are removed, unless calibration_only is
// true. kUsage: options that do not exist or contradict each other; the folder holds a light field,
// in any form, and `overwrite` is false; an output is one of the inputs. kOutput: the folder or the
// disk fails. kInterrupted: keep_going() returned false.
Result<void> WriteSyntheticField(const SyntheticFieldOptions& options, ThreadPool& pool,
                                 const SyntheticProgress& keep_going);

}  // namespace lf
