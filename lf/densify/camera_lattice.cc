// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/camera_lattice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

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

// Natural neighbours exist only strictly inside the hull.
constexpr double kInwards = 1e-3;

Vec2 MiddleOf(std::span<const Vec2> hull) {
  return std::accumulate(hull.begin(), hull.end(), Vec2(Vec2::Zero())) /
         static_cast<double>(hull.size());
}

// Returns the place with its neighbours among points on one line, by linear interpolation.
LatticePlace PlaceOnLine(std::span<const Vec2> points, const Vec2& place) {
  const auto [least, most] =
      std::minmax_element(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
        return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
      });
  const Vec2 along = *most - *least;
  LatticePlace at{place, *least, {{static_cast<uint32_t>(least - points.begin()), 1}}};
  if (along.squaredNorm() == 0) return at;
  const auto share_of = [&](const Vec2& point) {
    return (point - *least).dot(along) / along.squaredNorm();
  };
  const double share = std::clamp(share_of(place), 0.0, 1.0);
  at.inside = *least + share * along;
  uint32_t before = at.neighbours[0].index, behind = static_cast<uint32_t>(most - points.begin());
  for (uint32_t i = 0; i < points.size(); ++i) {
    const double here = share_of(points[i]);
    if (here <= share && here > share_of(points[before])) before = i;
    if (here >= share && here < share_of(points[behind])) behind = i;
  }
  const double gap = share_of(points[behind]) - share_of(points[before]);
  const double part = gap > 0 ? (share - share_of(points[before])) / gap : 0;
  at.neighbours = {{before, 1 - part}, {behind, part}};
  if (part > 0.5) std::swap(at.neighbours[0], at.neighbours[1]);
  if (at.neighbours[1].weight == 0) at.neighbours.pop_back();
  return at;
}

// Returns the place with its neighbours among points with this hull, which surrounds an area. None
// if the place is more than `outside` beyond it.
std::optional<LatticePlace> PlaceInHull(std::span<const Vec2> points, std::span<const Vec2> hull,
                                        const Vec2& place, double outside) {
  LatticePlace at{place, place, NaturalNeighbours(points, place)};
  if (!at.neighbours.empty()) return at;
  const Vec2 edge = NearestOn(hull, place);
  if ((edge - place).norm() > outside) return std::nullopt;
  at.inside = edge + kInwards * (MiddleOf(hull) - edge);
  at.neighbours = NaturalNeighbours(points, at.inside);
  if (at.neighbours.empty()) return std::nullopt;
  return at;
}

}  // namespace

LatticePlace PlaceAmong(std::span<const Vec2> points, const Vec2& place) {
  if (!AreOnOneLine(points)) {
    const std::vector<Vec2> hull = ConvexHull(points);
    if (std::optional<LatticePlace> at = PlaceInHull(points, hull, place, INFINITY))
      return *std::move(at);
  }
  return PlaceOnLine(points, place);
}

std::vector<LatticePlace> LatticeAmong(std::span<const Vec2> points, double distance,
                                       double outside) {
  constexpr double kRow = 0.86602540378443865;
  const std::vector<Vec2> hull = ConvexHull(points);
  const Box box = BoxOf(points);
  std::vector<LatticePlace> lattice;
  int row = 0;
  for (double y = box.least.y() - outside; y <= box.most.y() + outside; y += kRow * distance, ++row)
    for (double x = box.least.x() - outside + (row % 2) * distance / 2; x <= box.most.x() + outside;
         x += distance) {
      const Vec2 place(x, y);
      const auto is_near = [&](const Vec2& point) { return (point - place).norm() < distance / 2; };
      if (std::any_of(points.begin(), points.end(), is_near)) continue;
      if (std::optional<LatticePlace> at = PlaceInHull(points, hull, place, outside))
        lattice.push_back(*std::move(at));
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
