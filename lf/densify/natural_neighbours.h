// SPDX-License-Identifier: Apache-2.0
// The points around a place of the plane, with weights for interpolation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

// A point beside another and its weight.
struct WeightedPoint {
  uint32_t index = 0;
  double weight = 0;
};

// Returns the natural neighbours of `place`: the points whose Voronoi cells it would border on. The
// weight of a neighbour is the length of that border divided by its distance (Belikov et al., "The
// non-Sibsonian interpolation", 1997). The weights add up to 1, and the weighted mean of the
// neighbours is `place`. The neighbours are sorted, the largest weight first. Returns none if
// `place` is outside the convex hull of the points.
//   points  may include `place` itself, which is then the only neighbour
std::vector<WeightedPoint> NaturalNeighbours(std::span<const Vec2> points, const Vec2& place);

// Returns the numbers of the points in the order of their distance from `place`.
std::vector<uint32_t> ByDistance(std::span<const Vec2> points, const Vec2& place);

}  // namespace lf
