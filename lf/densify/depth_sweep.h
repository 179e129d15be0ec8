// SPDX-License-Identifier: Apache-2.0
// Finds the inverse depth of every pixel of an LF image by a plane sweep and semi-global matching.
#pragma once

#include <span>

#include "lf/densify/depth_plane.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/matching_costs.h"
#include "lf/densify/watched_loop.h"
#include "lf/densify/working_image.h"

namespace lf {

// Returns the plane that semi-global matching chooses, smoothed by a median of 3 x 3 pixels.
//
// Small images are compared at all inverse depths. Larger ones are reduced first, and the depths of
// the reduced image say which inverse depths are compared in each block of pixels: those that were
// found in it and beside it, and a few around each of them. Next to an outline, these are the
// depths on both sides. A surface that is too narrow to be found in the reduced image may be
// missed.
//
// Images are matched in tiles that overlap, so that the memory is bounded.
//   views        one or more
//   planes       number of inverse depths that are distinguished, 2 or more
//   interrupted  once it is set, the result must not be used
DepthPlane SweepDepths(const WorkingImage& reference, std::span<const SweepView> views,
                       const InverseDepths& range, int planes, InterruptFlag interrupted = nullptr);

// Returns about which share of the inverse depths are compared for a pixel of an image of this
// size.
double ComparedShare(int width, int height);

}  // namespace lf
