// A whole frame out of rebinned rays: one ray for each element and lens point, each interpolated as
// in ray_query.h, and their mean (thesis 4.3.2, "Rendering Phase").
//
// Not asked ray by ray: lens points are shared by all elements, so that for one of them every
// rebinned ray near it is added, weighed, to the elements within its reach. The sums are the same,
// and there is no tree (doc/rebinning.md).
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
  Image<float> share;  // [height][width]: how many of the lens points these were, 0 to 1
};

// Elements that no ray is near have share 0 and black. The same bits for any number of threads.
//   rays    of this frame, with a reach of kReach_sigmas (ReachOf())
//   shares  weighs the lens points in both answers; null: all count 1
SplatFrame Splat(std::span<const FrameRay> rays, int width_px, int height_px,
                 const LensPointSets& lens_points, const QueryKernel& kernel, ThreadPool& pool,
                 const PointShares* shares = nullptr);

FrameReach ReachOf(const QueryKernel& kernel, const LensPointSets& lens_points);

// The same by queries, one element after the other: the judge.
//   nearest  not 0: of so many rays, however far, in place of those within reach
SplatFrame SplatReference(std::span<const FrameRay> rays, int width_px, int height_px,
                          const LensPointSets& lens_points, const QueryKernel& kernel,
                          ThreadPool& pool, const PointShares* shares = nullptr,
                          size_t nearest = 0);

}  // namespace lf
