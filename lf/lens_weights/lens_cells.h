// The lens as an integral over its area (doc/ray.md, "What is added"): what share of it each LF
// camera stands for.
#pragma once

#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"
#include "lf/lens_weights/covered_region.h"

namespace lf {

// Cells: a camera stands for the part of the opening that is nearer to it than to any other, its
// Voronoi cell, cut by what is covered at all. Exact but for rounding, a part in 1e-12. The shares'
// sum is the covered part of the opening, 1 if that is all, as soon as there is a point, in the
// opening or not: cells of points beside it reach in. Points at the same place share alike.
//   points    where rays of the LF cameras meet the lens plane, lens coordinates; finite, any
//             number and arrangement
//   aperture  radius_w > 0
// About a microsecond a point.
std::vector<double> CellShares(std::span<const Vec2> points, const Aperture& aperture,
                               const CoveredRegion& covered = {});

// Hats: every point of the opening is seen by the cameras around it, in the shares in which a
// camera there would take its cell from theirs (natural neighbours; Sibson 1981). A camera's share
// is the mean over the opening, by `sample_count` points of it. These are the weights for openings
// that are small beside the distances of the cameras, pinholes among them: a picture between
// cameras is interpolated, and moves smoothly from one to the next. Outside of all cameras the
// nearest ones share alike. The sum is 1 as soon as there is a point. Points at the same place
// share alike.
//   aperture  radius_w >= 0; at 0 one sample is enough
// Some microseconds a sample.
std::vector<double> HatShares(std::span<const Vec2> points, const Aperture& aperture,
                              int sample_count = 64);

}  // namespace lf
