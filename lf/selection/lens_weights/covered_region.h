// The part of the lens plane whose light is known. A lens may be wider than the capture.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/selection/lens_weights/convex_polygon.h"

namespace lf {

// The convex hull of the points where rays of LF cameras meet the lens plane, and a margin around
// it. No LF camera stands for the lens beyond it. Otherwise, the LF cameras at the rim of the
// capture would stand for all of the rest, and be visible as bright outlines in areas out of focus.
class CoveredRegion {
 public:
  // Makes the whole plane.
  CoveredRegion() = default;
  //   points    lens coordinates; finite, at least one
  //   margin_w  reach of LF cameras at the rim: half a camera distance, as between LF cameras
  CoveredRegion(std::span<const Vec2> points, double margin_w);

  // Keeps the part of the polygon within the region. Exact.
  void Clip(ConvexPolygon* polygon) const;
  bool Contains(const Vec2& place) const;

  // Radius of the largest disk around the lens centre within the region: 0 if the centre is
  // outside, infinite for the whole plane.
  double LargestRadius_w() const;

 private:
  struct Side {
    Vec2 normal;  // outwards, of length 1
    double offset_w;
  };
  std::vector<Side> sides_;
};

}  // namespace lf
