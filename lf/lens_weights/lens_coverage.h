// How well LF cameras cover a lens: what a photographer should know before a night's work.
#pragma once

#include <span>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"
#include "lf/lens_weights/covered_region.h"

namespace lf {

// Farther than so many camera distances from every LF camera nothing is known of the light.
inline constexpr double kFarDistances = 2;

// Returns how far LF cameras are apart, for CoveredRegion: distance of points to their nearest
// neighbour, the middle (median) one by the areas that points stand for, those at nearly the same
// place taken for one. 0 without two different points.
double DistanceOfMost(std::span<const Vec2> points);

// The region with a margin of half that distance; the whole plane without two different points.
CoveredRegion CoveredBy(std::span<const Vec2> points);

// From this uncovered share on people are told.
inline constexpr double kMuchUncovered = 0.1;

struct LensCoverage {
  // The share of the opening that is beyond CoveredBy(points), if that is wider than
  // DistanceOfMost(), or farther from every point than kFarDistances times this. Of a pinhole its
  // middle, 0 or 1. True to 1 / 256 or so. 1 without two different points.
  double uncovered_share = 1;
  // The diameter of the largest aperture around the same middle that is within the region.
  double fitting_diameter_w = 0;
};

//   points  where rays of the LF cameras meet the lens plane, lens coordinates
LensCoverage CoverageOf(std::span<const Vec2> points, const Aperture& aperture);

}  // namespace lf
