// SPDX-License-Identifier: Apache-2.0
// Measures how well LF cameras cover a lens, so that a photographer knows this before hours of
// rendering.
#pragma once

#include <span>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"

namespace lf {

class CoveredRegion;  // covered_region.h

// The light at a point of the lens is unknown if the rays of all LF cameras meet the lens plane
// farther than this from the point, in units of the distance between LF cameras.
inline constexpr double kFarDistances = 2;

// Returns the distance between LF cameras: the median of the distances of points from their nearest
// neighbours, weighted by the squares of these distances (about the area that a point represents).
// Points at almost the same place count as one. 0 if there are no two different points.
double DistanceOfMost(std::span<const Vec2> points);

// Returns the covered region with a margin of DistanceOfMost() / 2; the whole plane if there are no
// two different points.
CoveredRegion CoveredBy(std::span<const Vec2> points);

// Programs warn if the uncovered share of a lens is above this.
inline constexpr double kMuchUncovered = 0.1;

struct LensCoverage {
  // Share of the opening that is farther from every point than kFarDistances * DistanceOfMost() or,
  // if the opening is wider than DistanceOfMost(), outside of CoveredBy(points). For a pinhole,
  // only its middle is tested: 0 or 1. Measured at 256 points of the opening. 1 if there are no two
  // different points.
  double uncovered_share = 1;
  // Diameter of the largest aperture with the same centre that is within CoveredBy(points); 0 if it
  // does not contain the centre, or if there are no two different points.
  double fitting_diameter_w = 0;
};

// Returns how well the LF cameras cover the opening of the lens.
//   points  one for each LF camera, in lens coordinates: the intersection of the lens plane with a
//           ray of the LF camera. The rays of all LF cameras pass through one focus point
LensCoverage CoverageOf(std::span<const Vec2> points, const Aperture& aperture);

}  // namespace lf
