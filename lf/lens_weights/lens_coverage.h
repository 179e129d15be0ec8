// How well LF cameras cover a lens: what a photographer should know before a night's work.
#pragma once

#include <span>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"

namespace lf {

// Farther than so many camera distances from every LF camera nothing is known of the light.
inline constexpr double kFarDistances = 2;

// The share of the opening that is farther from every point than kFarDistances times the distance
// of points to their nearest neighbour: the middle (median) one by the areas that points stand for,
// those at nearly the same place taken for one. Of a pinhole its middle, 0 or 1. True to 1 / 256 or
// so. 1 without two different points.
//   points  where rays of the LF cameras meet the lens plane, lens coordinates
double UncoveredShare(std::span<const Vec2> points, const Aperture& aperture);

}  // namespace lf
