// SPDX-License-Identifier: Apache-2.0
// Makes the completion of a frame from a plate of kept rays.
#pragma once

#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/film/develop/develop.h"

namespace lf {

class SensorPlate;  // film/plate/sensor_plate.h

// Returns the means of a plate of kept rays, with their share in a frame.
//
// plate  must not be guarded
// share  [height][width] as Completion::share. Becomes 0 in an element that has no ray in any
//        channel.
// pool   null: one thread. The bits do not depend on the number of threads.
//
// Mosaics may have elements with rays in some channels (colours, opacity) only. A channel that
// lacks rays there takes the inverse-distance mean by which Develop() fills channels, from elements
// of the plate that are at most kFillRadius_px away. If there are none, the share of the element
// becomes 0, because a colour is not known without all of its channels. An element without any ray
// is not filled here: Develop() fills it, from collected and completed elements.
Completion CompletionOf(const SensorPlate& plate, Image<float> share, ThreadPool* pool = nullptr);

}  // namespace lf
