#include "lf/selection/lens_weights/covered_region.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"

namespace lf {
namespace {

// Returns the corners of the convex hull counter-clockwise, without points on its edges. If all
// points are equal or on a line, returns one or two points. (Andrew's monotone chains.)
std::vector<Vec2> ConvexHull(std::span<const Vec2> points) {
  std::vector<Vec2> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  if (sorted.size() < 3) return sorted;
  std::vector<Vec2> hull;
  const auto add_chain = [&](auto begin, auto end) {
    const size_t first = hull.size();
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= first + 2 &&
             Cross(hull.back() - hull[hull.size() - 2], *it - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();  // the other chain begins with this point
  };
  add_chain(sorted.begin(), sorted.end());
  add_chain(sorted.rbegin(), sorted.rend());
  return hull;
}

}  // namespace

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

bool CoveredRegion::Contains(const Vec2& place) const {
  return std::all_of(sides_.begin(), sides_.end(),
                     [&](const Side& side) { return side.normal.dot(place) <= side.offset_w; });
}

double CoveredRegion::LargestRadius_w() const {
  double radius_w = std::numeric_limits<double>::infinity();
  for (const Side& side : sides_) radius_w = std::min(radius_w, side.offset_w);
  return std::max(0.0, radius_w);
}

}  // namespace lf
