// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/camera_lattice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lf/core/convex_hull.h"

namespace lf {
namespace {

struct Box {
  Vec2 least, most;
};
Box BoxOf(std::span<const Vec2> points) {
  Box box{points[0], points[0]};
  for (const Vec2& point : points) {
    box.least = box.least.cwiseMin(point);
    box.most = box.most.cwiseMax(point);
  }
  return box;
}

// Returns the point on the border of a polygon that is nearest to `place`.
Vec2 NearestOn(std::span<const Vec2> polygon, const Vec2& place) {
  Vec2 nearest = polygon[0];
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 side = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double along = (place - polygon[i]).dot(side) / side.squaredNorm();
    const Vec2 point = polygon[i] + std::clamp(along, 0.0, 1.0) * side;
    if ((point - place).norm() < (nearest - place).norm()) nearest = point;
  }
  return nearest;
}

}  // namespace

std::vector<LatticePlace> LatticeAmong(std::span<const Vec2> points, double distance,
                                       double outside) {
  constexpr double kRow = 0.86602540378443865;
  // Natural neighbours exist only strictly inside the hull.
  constexpr double kInwards = 1e-3;
  const std::vector<Vec2> hull = ConvexHull(points);
  const Vec2 middle = std::accumulate(hull.begin(), hull.end(), Vec2(Vec2::Zero())) /
                      static_cast<double>(hull.size());
  const Box box = BoxOf(points);
  std::vector<LatticePlace> lattice;
  int row = 0;
  for (double y = box.least.y() - outside; y <= box.most.y() + outside; y += kRow * distance, ++row)
    for (double x = box.least.x() - outside + (row % 2) * distance / 2; x <= box.most.x() + outside;
         x += distance) {
      LatticePlace at{{x, y}, {x, y}, {}};
      const auto is_near = [&](const Vec2& point) {
        return (point - at.place).norm() < distance / 2;
      };
      if (std::any_of(points.begin(), points.end(), is_near)) continue;
      at.neighbours = NaturalNeighbours(points, at.place);
      if (at.neighbours.empty()) {
        const Vec2 edge = NearestOn(hull, at.place);
        if ((edge - at.place).norm() > outside) continue;
        at.inside = edge + kInwards * (middle - edge);
        at.neighbours = NaturalNeighbours(points, at.inside);
      }
      if (!at.neighbours.empty()) lattice.push_back(std::move(at));
    }
  return lattice;
}

double DistanceForPlaces(std::span<const Vec2> points, double count) {
  const Box box = BoxOf(points);
  return std::sqrt((box.most - box.least).prod() / count);
}

bool AreOnOneLine(std::span<const Vec2> points) {
  constexpr double kThin = 1e-4;  // width of the hull by its length
  const std::vector<Vec2> hull = ConvexHull(points);
  double area = 0, length = 0;
  for (size_t i = 0; i < hull.size(); ++i) {
    area += Cross(hull[i], hull[(i + 1) % hull.size()]) / 2;
    length = std::max(length, (hull[i] - hull[0]).norm());
  }
  return hull.size() < 3 || area <= kThin * length * length;
}

}  // namespace lf
