// SPDX-License-Identifier: Apache-2.0
// The depths of the scene that a forecast assumes.
#pragma once

#include "lf/camera/path/camera_path.h"
#include "lf/core/parallel.h"
#include "lf/distribute/preprocess/preprocess.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

enum class DepthSource {
  kUnknown,
  kStated,       // PreprocessOptions::depths
  kCalibration,  // LightField::depth_range
  kLfImages,     // found by comparing LF images
};

// Returns where the depths of the scene are from: the stated ones, those of the calibration, or
// else those that are found by comparing LF images. Sets options->depths in the last case.
DepthSource KnowDepths(const LightField& light_field, const CameraPath& path, ThreadPool& pool,
                       PreprocessOptions* options);

}  // namespace lf
