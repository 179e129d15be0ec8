// SPDX-License-Identifier: Apache-2.0
// The part of the lens plane whose light the LF cameras have recorded. A lens may extend beyond it.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/selection/lens_weights/convex_polygon.h"

namespace lf {

// The convex hull of the points where rays of LF cameras meet the lens plane, extended by a margin.
// No LF camera represents the part of the lens beyond this region, because otherwise the LF cameras
// at the rim of the capture would represent all of that part, and out-of-focus areas would show
// them as bright outlines.
class CoveredRegion {
 public:
  // Makes a region that is the whole lens plane.
  CoveredRegion() = default;
  //   points    at least one, finite, in lens coordinates
  //   margin_w  width of the margin: half the distance between LF cameras, because an LF camera
  //             between others also represents the lens up to half this distance
  CoveredRegion(std::span<const Vec2> points, double margin_w);

  // Replaces the polygon by its exact intersection with the region.
  void Clip(ConvexPolygon* polygon) const;
  bool Contains(const Vec2& place) const;
  // Returns how far a place is beyond the side that it is farthest beyond; below 0 inside the
  // region, and minus infinity if the region is the whole plane.
  double Beyond_w(const Vec2& place) const;
  bool ContainsDisk(const Vec2& middle, double radius_w) const;

  // Returns the radius of the largest disk around the lens centre that is within the region: 0 if
  // the centre is outside, infinity if the region is the whole plane.
  double LargestRadius_w() const;

 private:
  struct Side {
    Vec2 normal;      // points outwards, has length 1
    double offset_w;  // normal . p of the points p on the side
  };
  std::vector<Side> sides_;
};

}  // namespace lf
