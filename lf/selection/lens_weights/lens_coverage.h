// Measures how well LF cameras cover a lens, which a photographer should know before a night's
// work.
#pragma once

#include <span>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"
#include "lf/selection/lens_weights/covered_region.h"

namespace lf {

// The light at a point is unknown if it is farther than so many camera distances from every LF
// camera.
inline constexpr double kFarDistances = 2;

// Returns the distance between LF cameras, for CoveredRegion: the median distance of points from
// their nearest neighbour, weighted by the area that each point stands for. Points at almost the
// same place count as one. 0 without two different points.
double DistanceOfMost(std::span<const Vec2> points);

// Returns the region with a margin of half that distance; the whole plane without two different
// points.
CoveredRegion CoveredBy(std::span<const Vec2> points);

// Uncovered share from which on people are told.
inline constexpr double kMuchUncovered = 0.1;

struct LensCoverage {
  // Share of the opening that is farther from every point than kFarDistances * DistanceOfMost() or,
  // if the opening is wider than DistanceOfMost(), beyond CoveredBy(points). For a pinhole, only
  // its middle counts: 0 or 1. Exact to about 1 / 256. 1 without two different points.
  double uncovered_share = 1;
  // Diameter of the largest aperture with the same centre that is within the region.
  double fitting_diameter_w = 0;
};

//   points  where rays of the LF cameras meet the lens plane, in lens coordinates
LensCoverage CoverageOf(std::span<const Vec2> points, const Aperture& aperture);

}  // namespace lf
