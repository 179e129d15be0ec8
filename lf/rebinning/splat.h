// Renders a whole frame from rebinned rays: an element is the mean of one ray for each lens point,
// interpolated as in ray_query.h (thesis 4.3.2, "Rendering Phase").
//
// Rays are not asked for one by one. All elements share the lens points, so each rebinned ray near
// a lens point is added, with its weight, to the elements within its reach. This gives the same
// sums without a tree (doc/rebinning.md).
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
  Image<float> rgb;    // [height][width][3]: mean of the rays that could be interpolated, linear
  Image<float> share;  // [height][width]: lens points with an interpolated ray / all, 0 to 1
};

// Renders a frame. Elements without a rebinned ray near them are black and have share 0. The bits
// do not depend on the number of threads.
//   rays    of this frame, with the reach ReachOf() (kReach_sigmas)
//   shares  weights of the lens points in both images; null: all weights are 1
SplatFrame Splat(std::span<const FrameRay> rays, int width_px, int height_px,
                 const LensPointSets& lens_points, const QueryKernel& kernel, ThreadPool& pool,
                 const PointShares* shares = nullptr);

FrameReach ReachOf(const QueryKernel& kernel, const LensPointSets& lens_points);

// The reference of Splat(): asks a RayQuery for every element and lens point.
//   nearest  if not 0, interpolates between the `nearest` nearest rays at any distance, instead of
//            the rays within reach
SplatFrame SplatReference(std::span<const FrameRay> rays, int width_px, int height_px,
                          const LensPointSets& lens_points, const QueryKernel& kernel,
                          ThreadPool& pool, const PointShares* shares = nullptr,
                          size_t nearest = 0);

}  // namespace lf
