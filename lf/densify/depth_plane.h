// SPDX-License-Identifier: Apache-2.0
// The inverse depth of every pixel of an LF image, compared with those of its neighbours.
#pragma once

#include <cstdint>
#include <span>

#include "lf/core/image.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/pair_map.h"
#include "lf/densify/watched_loop.h"
#include "lf/densify/working_image.h"

namespace lf {

// Numbers of InverseDepths, [height][width], for a working image.
using DepthPlane = Image<uint16_t>;

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
