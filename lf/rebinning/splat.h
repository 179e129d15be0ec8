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
#include "lf/rebinning/ray_query.h"

namespace lf {

struct SplatFrame {
  Image<float> rgb;    // [height][width][3]: mean of the rays that could be interpolated, linear
  Image<float> share;  // [height][width]: how many of the lens points these were, 0 to 1
};

// How much of each lens point is asked for, all over the plate: the others do without it. From
// nodes on a grid, from edge to edge of the plate; between them it is interpolated.
struct PointShares {
  int columns = 1;
  int rows = 1;
  size_t point_count = 0;     // of all sets, one set after the other
  std::vector<float> values;  // [rows][columns][point_count], 0 to 1

  // Of `count` points from `first` on, at an element.
  void At(int x, int y, int width_px, int height_px, size_t first, size_t count, float* out) const;
  // Squares with elements that ask for some, or have such within reach_px.
  AskedSquares Squares(int width_px, int height_px, double reach_px) const;
  // Of one of them alone.
  PointShares OfPoint(size_t point) const;
  // Of each set, how much of its points is asked for: one after the other.
  PointShares MeansOfSets(const LensPointSets& points) const;
  // Whether any of these is asked for by an element of the rectangle.
  bool IsAny(const PixelRect& rect, int width_px, int height_px, size_t first, size_t count) const;
};

// Elements that no ray is near have share 0 and black. The same bits for any number of threads.
//   rays    of this frame, with a reach of kReach_sigmas (ReachOf())
//   shares  weighs the lens points in both answers; null: all count 1
SplatFrame Splat(std::span<const FrameRay> rays, int width_px, int height_px,
                 const LensPointSets& lens_points, const QueryKernel& kernel, ThreadPool& pool,
                 const PointShares* shares = nullptr);

FrameReach ReachOf(const QueryKernel& kernel, const LensPointSets& lens_points);

// The same by queries, one element after the other: the judge.
SplatFrame SplatReference(std::span<const FrameRay> rays, int width_px, int height_px,
                          const LensPointSets& lens_points, const QueryKernel& kernel,
                          ThreadPool& pool, const PointShares* shares = nullptr);

}  // namespace lf
