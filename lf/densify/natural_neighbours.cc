// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/natural_neighbours.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lf {
namespace {

// A convex polygon that remembers which clip made each of its sides.
class Cell {
 public:
  static constexpr uint32_t kBorder = UINT32_MAX;

  explicit Cell(double half_side)
      : corners_{{{-half_side, -half_side}, kBorder},
                 {{half_side, -half_side}, kBorder},
                 {{half_side, half_side}, kBorder},
                 {{-half_side, half_side}, kBorder}} {}

  struct Corner {
    Vec2 at;
    uint32_t side = kBorder;  // the clip that made the side from this corner to the next
  };
  const std::vector<Corner>& corners() const { return corners_; }

  // Keeps the points that are nearer to 0 than to `point`.
  void ClipBy(const Vec2& point, uint32_t index) {
    const double offset = point.squaredNorm() / 2;
    const auto beyond = [&](const Vec2& at) { return point.dot(at) - offset; };
    std::vector<Corner> kept;
    for (size_t i = 0; i < corners_.size(); ++i) {
      const Corner& here = corners_[i];
      const Corner& next = corners_[(i + 1) % corners_.size()];
      const double a = beyond(here.at), b = beyond(next.at);
      if (a <= 0) kept.push_back(here);
      if ((a <= 0) == (b <= 0)) continue;
      const Vec2 cut = here.at + (next.at - here.at) * (a / (a - b));
      kept.push_back({cut, a <= 0 ? index : here.side});
    }
    corners_ = std::move(kept);
  }
  double Reach() const {
    double reach = 0;
    for (const Corner& corner : corners_) reach = std::max(reach, corner.at.norm());
    return reach;
  }

 private:
  std::vector<Corner> corners_;  // counter-clockwise
};

}  // namespace

std::vector<uint32_t> ByDistance(std::span<const Vec2> points, const Vec2& place) {
  std::vector<uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return (points[a] - place).squaredNorm() < (points[b] - place).squaredNorm();
  });
  return order;
}

std::vector<WeightedPoint> NaturalNeighbours(std::span<const Vec2> points, const Vec2& place) {
  double extent = 0;
  for (const Vec2& point : points) extent = std::max(extent, (point - points[0]).norm());
  // Cells of places inside the hull end far within this square.
  constexpr double kFar = 1e4, kSame = 1e-9;
  Cell cell(kFar * extent);
  for (const uint32_t i : ByDistance(points, place)) {
    const Vec2 offset = points[i] - place;
    const double distance = offset.norm();
    if (distance <= kSame * extent) return {{i, 1}};
    if (distance > 2 * cell.Reach()) break;
    cell.ClipBy(offset, i);
  }
  std::vector<WeightedPoint> found;
  double sum = 0;
  const std::vector<Cell::Corner>& corners = cell.corners();
  for (size_t k = 0; k < corners.size(); ++k) {
    const uint32_t side = corners[k].side;
    if (side == Cell::kBorder) return {};
    const double length = (corners[(k + 1) % corners.size()].at - corners[k].at).norm();
    const double weight = length / (points[side] - place).norm();
    found.push_back({side, weight});
    sum += weight;
  }
  for (WeightedPoint& point : found) point.weight /= sum;
  std::stable_sort(found.begin(), found.end(), [](const WeightedPoint& a, const WeightedPoint& b) {
    return a.weight > b.weight;
  });
  return found;
}

}  // namespace lf
