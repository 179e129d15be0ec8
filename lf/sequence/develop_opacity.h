// The fourth channel of a plate, developed (develop.h). Internal to this folder.
#pragma once

#include <functional>

#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/plate/sensor_plate.h"
#include "lf/sequence/develop.h"

namespace lf {

// Averages opacities [height][width] and fills them as Develop() does colours: their rays are those
// of the colours, so that the same elements are filled, from the same neighbours.
//   is_interrupted  asked by any thread; once it is true, the answer is of no use
Image<float> DevelopOpacity(const SensorPlate& plate, const DevelopOptions& options,
                            const std::function<bool()>& is_interrupted, ThreadPool& pool);

}  // namespace lf
