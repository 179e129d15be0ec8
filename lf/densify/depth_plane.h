// SPDX-License-Identifier: Apache-2.0
// The inverse depth of every pixel of an LF image, from the comparison with its neighbours.
#pragma once

#include <cstdint>
#include <span>

#include "lf/core/image.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/matching_costs.h"
#include "lf/densify/watched_loop.h"
#include "lf/densify/working_image.h"

namespace lf {

// Numbers of InverseDepths, [height][width], for a working image.
using DepthPlane = Image<uint16_t>;

// Returns the plane that semi-global matching chooses, smoothed by a median of 3 x 3 pixels. Large
// images are matched in tiles that overlap, so that the memory is bounded.
//   views        one or more
//   planes       number of inverse depths that are compared, 2 or more
//   interrupted  once it is set, the result must not be used
DepthPlane SweepDepths(const WorkingImage& reference, std::span<const SweepView> views,
                       const InverseDepths& range, int planes, InterruptFlag interrupted = nullptr);

// A neighbour of an LF image with its depth plane.
struct DepthView {
  const DepthPlane* plane = nullptr;
  PairMap from_reference;
};

// Returns, for each pixel, how many neighbours have the same inverse depth, within `tolerance`, at
// the place where they show the pixel; 0 for transparent pixels, which have no depth. Once
// `interrupted` is set, the result must not be used.
//   tones  of the working image
Image<uint8_t> CountAgreeing(const DepthPlane& plane, const Image<uint16_t>& tones,
                             std::span<const DepthView> views, const InverseDepths& range,
                             double tolerance, InterruptFlag interrupted = nullptr);

// Replaces the depths of pixels on which fewer than `wanted` neighbours agree. Such a pixel takes
// the depth of the nearest pixel with enough agreement in one of eight directions: the one with the
// most similar tones, where far depths are preferred, because most of these pixels belong to a
// background that other LF images do not see.
//   agreeing              CountAgreeing() of the plane
//   shift_per_depth_px    ShiftPerInverseDepth() of typical neighbours
//   interrupted           once it is set, the result must not be used
DepthPlane FillDisagreeing(const DepthPlane& plane, const Image<uint8_t>& agreeing, int wanted,
                           const Image<uint16_t>& tones, const InverseDepths& range,
                           double shift_per_depth_px, InterruptFlag interrupted = nullptr);

}  // namespace lf
