// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/covered_region.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"
#include "lf/core/convex_hull.h"

namespace lf {

CoveredRegion::CoveredRegion(std::span<const Vec2> points, double margin_w) {
  LF_CHECK(!points.empty() && margin_w >= 0);
  const std::vector<Vec2> hull = ConvexHull(points);
  const auto add = [&](const Vec2& normal) {
    double farthest_w = -std::numeric_limits<double>::infinity();
    for (const Vec2& corner : hull) farthest_w = std::max(farthest_w, normal.dot(corner));
    sides_.push_back({normal, farthest_w + margin_w});
  };
  if (hull.size() == 1) {
    for (const Vec2& normal : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) add(normal);
    return;
  }
  // If the hull has two points (the cameras are on a line), the region is a rectangle around the
  // line.
  for (size_t i = 0; i < hull.size(); ++i) {
    const Vec2 along = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    add(Vec2(along.y(), -along.x()));
    if (hull.size() == 2) add(along);
  }
}

void CoveredRegion::Clip(ConvexPolygon* polygon) const {
  for (const Side& side : sides_) {
    if (polygon->empty()) return;
    polygon->Clip(side.normal, side.offset_w);
  }
}

bool CoveredRegion::Contains(const Vec2& place) const { return ContainsDisk(place, 0); }

bool CoveredRegion::ContainsDisk(const Vec2& middle, double radius_w) const {
  return std::all_of(sides_.begin(), sides_.end(), [&](const Side& side) {
    return side.normal.dot(middle) + radius_w <= side.offset_w;
  });
}

double CoveredRegion::Beyond_w(const Vec2& place) const {
  double beyond_w = -std::numeric_limits<double>::infinity();
  for (const Side& side : sides_)
    beyond_w = std::max(beyond_w, side.normal.dot(place) - side.offset_w);
  return beyond_w;
}

double CoveredRegion::LargestRadius_w() const {
  double radius_w = std::numeric_limits<double>::infinity();
  for (const Side& side : sides_) radius_w = std::min(radius_w, side.offset_w);
  return std::max(0.0, radius_w);
}

}  // namespace lf
