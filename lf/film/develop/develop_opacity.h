// SPDX-License-Identifier: Apache-2.0
// Develops the opacities of a plate, its fourth channel (develop.h). Internal to this folder.
#pragma once

#include <functional>

#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/film/develop/develop.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {

// Averages opacities [height][width], those of a guarded plate by its formula, mixes them with
// those of the completion, and fills them as Develop() fills colours. Opacities are summed over the
// same rays as colours, so the same elements are filled from the same neighbours.
//   is_interrupted  called by any thread; once it returns true, the result must not be used
Image<float> DevelopOpacity(const SensorPlate& plate, const DevelopOptions& options,
                            const std::function<bool()>& is_interrupted, ThreadPool& pool);

}  // namespace lf
