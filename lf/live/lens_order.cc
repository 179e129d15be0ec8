// SPDX-License-Identifier: Apache-2.0
#include "lf/live/lens_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <unordered_map>

namespace lf {

namespace {

// Points in the cells of a grid, so that those near a place are found quickly.
class PointCells {
 public:
  //   far2  a number for each point; points for which it is negative are left out
  PointCells(std::span<const Vec2> points, const std::vector<double>& far2, double width_w)
      : width_w_(width_w) {
    for (size_t i = 0; i < points.size(); ++i)
      if (far2[i] >= 0) cells_[KeyOf(CellOf(points[i].x()), CellOf(points[i].y()))].push_back(i);
  }
  double width_w() const { return width_w_; }

  // Calls body(i) at least for all points whose distance from the place is at most width_w().
  template <class Body>
  void ForEachNear(const Vec2& place, const Body& body) const {
    const int64_t column = CellOf(place.x()), row = CellOf(place.y());
    for (int64_t y = row - 1; y <= row + 1; ++y)
      for (int64_t x = column - 1; x <= column + 1; ++x)
        if (const auto cell = cells_.find(KeyOf(x, y)); cell != cells_.end())
          for (const size_t i : cell->second) body(i);
  }

 private:
  int64_t CellOf(double coordinate_w) const {
    constexpr double kMost = 1e15;
    return static_cast<int64_t>(std::floor(std::clamp(coordinate_w / width_w_, -kMost, kMost)));
  }
  // Different cells may have equal keys. They are then searched together, which only costs time.
  static uint64_t KeyOf(int64_t x, int64_t y) {
    constexpr uint64_t kOdd = 0x9e3779b97f4a7c15;
    return static_cast<uint64_t>(x) * kOdd + static_cast<uint64_t>(y);
  }

  const double width_w_;
  std::unordered_map<uint64_t, std::vector<size_t>> cells_;
};

}  // namespace

std::vector<size_t> FarthestPointOrder(std::span<const Vec2> points, size_t count,
                                       size_t preferred_count) {
  constexpr double kChosen = -1;
  constexpr double kPreference = 4;  // factor of the squared distances of preferred points
  struct Candidate {
    double value;
    size_t index;
    bool operator<(const Candidate& other) const {
      return value != other.value ? value < other.value : index > other.index;
    }
  };
  count = std::min(count, points.size());
  if (count == 0) return {};
  // Squared distances from the chosen points.
  std::vector<double> far2(points.size(), std::numeric_limits<double>::infinity());
  const auto value_of = [&](size_t i) { return far2[i] * (i < preferred_count ? kPreference : 1); };
  std::priority_queue<Candidate> queue;  // candidates whose value has changed since are skipped
  const auto nearest = std::min_element(
      points.begin(), points.end(),
      [](const Vec2& a, const Vec2& b) { return a.squaredNorm() < b.squaredNorm(); });
  std::vector<size_t> chosen = {static_cast<size_t>(nearest - points.begin())};
  // The cells are at least as wide as the largest distance of a point from the chosen points. A
  // newly chosen point therefore changes only distances of points in its own and adjacent cells.
  std::optional<PointCells> cells;
  while (true) {
    const size_t newest = chosen.back();
    far2[newest] = kChosen;
    if (chosen.size() == count) return chosen;
    const auto approach = [&](size_t i) {
      const double distance2 = (points[i] - points[newest]).squaredNorm();
      if (distance2 >= far2[i]) return;
      far2[i] = distance2;
      queue.push({value_of(i), i});
    };
    if (cells)
      cells->ForEachNear(points[newest], approach);
    else
      for (size_t i = 0; i < points.size(); ++i) approach(i);
    while (queue.top().value != value_of(queue.top().index)) queue.pop();
    chosen.push_back(queue.top().index);
    const double reach_w = std::sqrt(queue.top().value);
    queue.pop();
    if (reach_w > 0 && (!cells || reach_w < cells->width_w() / 2))
      cells.emplace(points, far2, reach_w);
  }
}

LensOrder OrderOverLens(std::span<const Vec2> points, double radius_w, size_t count,
                        size_t preferred_count) {
  constexpr double kAtRim = 1.1;
  std::vector<size_t> inside, outside;
  std::vector<Vec2> of_inside;
  size_t preferred_inside = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].norm() <= kAtRim * radius_w)) {
      outside.push_back(i);
      continue;
    }
    inside.push_back(i);
    of_inside.push_back(points[i]);
    preferred_inside += i < preferred_count ? 1 : 0;
  }
  // A point is not a number if its LF camera stands in the focus plane. Such points come last.
  const auto far2 = [&](size_t i) {
    const double distance2 = points[i].squaredNorm();
    return std::isnan(distance2) ? std::numeric_limits<double>::infinity() : distance2;
  };
  std::stable_sort(outside.begin(), outside.end(),
                   [&](size_t a, size_t b) { return far2(a) < far2(b); });
  LensOrder order;
  for (const size_t i : FarthestPointOrder(of_inside, count, preferred_inside))
    order.indices.push_back(inside[i]);
  order.inside_count = order.indices.size();
  for (const size_t i : outside)
    if (order.indices.size() < count) order.indices.push_back(i);
  return order;
}

}  // namespace lf
