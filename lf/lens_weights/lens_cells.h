// The lens as an integral over its area (doc/ray.md, "What is added"): each LF camera stands for the part
// of the lens that is nearer to it than to any other, its Voronoi cell, cut by the opening.
#pragma once

#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"

namespace lf {

// The area of each point's cell within the opening, in squared world units: exact but for rounding,
// a part in 1e-12 of the opening. Their sum is Area(aperture) as soon as there is a point, in the
// opening or not: cells of points beside it reach in. Points at the same place share their cell.
//   points    in lens coordinates, finite, any number and arrangement
//   aperture  radius_w > 0
// About a microsecond a point.
std::vector<double> LensCellAreas(std::span<const Vec2> points, const Aperture& aperture);

}  // namespace lf
