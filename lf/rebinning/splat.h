// SPDX-License-Identifier: Apache-2.0
// Renders a whole frame from rebinned rays: an element is the mean of one ray for each lens point,
// interpolated as in ray_query.h (thesis 4.3.2, "Rendering Phase").
//
// Queries are not answered one by one. All elements of a set (LensPointSets) share its lens points,
// so each rebinned ray near a lens point is added, with its weight, to the set's elements within
// its reach. The sums are the same, but no k-d tree is needed (doc/rebinning.md).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/rebinning/frame_rays.h"
#include "lf/rebinning/lens_points.h"
#include "lf/rebinning/point_shares.h"
#include "lf/rebinning/ray_query.h"

namespace lf {

struct SplatFrame {
  Image<float> rgb;  // [height][width][3]: mean of the rays that could be interpolated, linear
  // [height][width]: the sum of the shares of those lens points whose ray could be interpolated
  // (without PointShares, each share is 1), divided by the number of lens points in the element's
  // set; 0 to 1
  Image<float> share;
};

// Renders a frame. Elements without a rebinned ray near them are black and have share 0. The bits
// do not depend on the number of threads.
//   rays    the rays of this frame (frame_rays.h) within ReachOf()
//   shares  weights of the lens points in `rgb` and `share`; null: all weights are 1
SplatFrame Splat(std::span<const FrameRay> rays, int width_px, int height_px,
                 const LensPointSets& lens_points, const QueryKernel& kernel, ThreadPool& pool,
                 const PointShares* shares = nullptr);

// Returns the reach of the kernel: kReach_sigmas sigmas on the plate and, for the lens point with
// the largest spread, on the lens.
FrameReach ReachOf(const QueryKernel& kernel, const LensPointSets& lens_points);

// The reference of Splat(): queries a RayQuery for every element and lens point.
//   nearest  if not 0, interpolates between the `nearest` nearest rays at any distance, instead of
//            the rays within reach
SplatFrame SplatReference(std::span<const FrameRay> rays, int width_px, int height_px,
                          const LensPointSets& lens_points, const QueryKernel& kernel,
                          ThreadPool& pool, const PointShares* shares = nullptr,
                          size_t nearest = 0);

}  // namespace lf
