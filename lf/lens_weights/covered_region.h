// The part of the lens plane in which the light is known: a lens may be wider than the capture.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/lens_weights/convex_polygon.h"

namespace lf {

// The convex hull of where rays of LF cameras meet the lens plane, and a margin around. What lies
// beyond it is empty: without it, the LF cameras at the rim of the capture would stand for all of
// that, and be seen as bright outlines in what is out of focus.
class CoveredRegion {
 public:
  // The whole plane.
  CoveredRegion() = default;
  //   points    lens coordinates; finite, at least one
  //   margin_w  how far LF cameras at the rim reach out: half a camera distance, as between them
  CoveredRegion(std::span<const Vec2> points, double margin_w);

  // Leaves the part within. Exact.
  void Clip(ConvexPolygon* polygon) const;
  bool Contains(const Vec2& place) const;

  // Radius of the largest disk around the lens centre within: 0 if the centre is beyond the region,
  // infinite for the whole plane.
  double LargestRadius_w() const;

 private:
  struct Side {
    Vec2 normal;  // outwards, of length 1
    double offset_w;
  };
  std::vector<Side> sides_;
};

}  // namespace lf
