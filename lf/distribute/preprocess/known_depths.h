// SPDX-License-Identifier: Apache-2.0
// The depths of the scene that a forecast assumes.
#pragma once

#include <string>

#include "lf/camera/path/camera_path.h"
#include "lf/core/parallel.h"
#include "lf/distribute/preprocess/preprocess.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the source of the scene's depths, as ForecastFacts::depths_from (forecast_report.h): the
// given ones, those of the calibration, or else those that are found by comparing LF images. Sets
// options->depths in the last case.
std::string KnowDepths(const LightField& light_field, const CameraPath& path, ThreadPool& pool,
                       PreprocessOptions* options);

}  // namespace lf
