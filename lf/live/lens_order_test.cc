// SPDX-License-Identifier: Apache-2.0
#include "lf/live/lens_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

std::vector<Vec2> RandomPoints(uint32_t count) {
  std::vector<Vec2> points;
  for (uint32_t i = 0; i < count; ++i)
    points.push_back({2 * RandomUnit(3, 0, i) - 1, 2 * RandomUnit(3, 1, i) - 1});
  return points;
}

// The largest distance of any point from the nearest of the chosen ones.
double Hole(const std::vector<Vec2>& points, const std::vector<size_t>& order, size_t count) {
  double hole = 0;
  for (const Vec2& point : points) {
    double nearest = 1e9;
    for (size_t i = 0; i < count; ++i)
      nearest = std::min(nearest, (point - points[order[i]]).norm());
    hole = std::max(hole, nearest);
  }
  return hole;
}

// Farthest-point sampling as it is defined.
std::vector<size_t> SlowOrder(const std::vector<Vec2>& points, size_t count, size_t preferred) {
  std::vector<size_t> chosen;
  while (chosen.size() < count) {
    size_t best = points.size();
    double best_value = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      if (std::count(chosen.begin(), chosen.end(), i) > 0) continue;
      double value = chosen.empty() ? -points[i].squaredNorm() : 1e9;
      for (const size_t one : chosen)
        value = std::min(value, (points[i] - points[one]).squaredNorm());
      if (!chosen.empty() && i < preferred) value *= 4;
      if (best < points.size() && value <= best_value) continue;
      best = i;
      best_value = value;
    }
    chosen.push_back(best);
  }
  return chosen;
}

TEST(LensOrder, IsFarthestPointSampling) {
  std::vector<Vec2> grid, clusters;
  for (int i = 0; i < 81; ++i) grid.push_back({i % 9, i / 9});  // many equal distances
  for (const Vec2& point : RandomPoints(60)) {
    clusters.push_back(1e-4 * point);
    clusters.push_back({5 + 0.01 * point.x(), 3});
    clusters.push_back({1, 1});
  }
  for (const std::vector<Vec2>& points : {RandomPoints(200), grid, clusters})
    for (const size_t preferred : {0, 30})
      for (const size_t count : {size_t{1}, size_t{17}, points.size()})
        EXPECT_EQ(FarthestPointOrder(points, count, preferred),
                  SlowOrder(points, count, preferred));
}

TEST(LensOrder, EveryBeginningIsSpread) {
  const std::vector<Vec2> points = RandomPoints(500);
  const std::vector<size_t> order = FarthestPointOrder(points, points.size());
  std::vector<size_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
  for (const Vec2& point : points) EXPECT_GE(point.norm(), points[order[0]].norm());
  // n points leave no hole wider than twice the smallest possible one (Gonzalez). n squares of side
  // 2 / sqrt(n) cover the square of side 2, and disks around these squares have a radius of
  // sqrt(2 / n).
  for (const size_t n : {4, 16, 64, 256})
    EXPECT_LE(Hole(points, order, n), 2 * std::sqrt(2.0 / static_cast<double>(n)));
}

TEST(LensOrder, PointsThroughTheLensComeFirst) {
  const std::vector<Vec2> points = {{3, 0}, {0.5, 0}, {-2, 0}, {1.05, 0}, {0, 0.1}, {-1, 0}};
  const LensOrder order = OrderOverLens(points, 1, 9);
  EXPECT_EQ(order.indices, (std::vector<size_t>{4, 3, 5, 1, 2, 0}));
  EXPECT_EQ(order.inside_count, 4U);
  EXPECT_EQ(OrderOverLens(points, 1, 2).indices, (std::vector<size_t>{4, 3}));
  EXPECT_EQ(OrderOverLens(points, 1, 5).indices, (std::vector<size_t>{4, 3, 5, 1, 2}));
  // Points 0 to 2 are preferred, of which only point 1 is in the lens.
  EXPECT_EQ(OrderOverLens(points, 1, 3, 3).indices, (std::vector<size_t>{4, 3, 1}));
  EXPECT_EQ(OrderOverLens({}, 1, 3).inside_count, 0U);
  const double nan = std::nan("");
  const std::vector<Vec2> undefined = {{nan, 0}, {0, 0}, {nan, nan}, {2, 0}};
  EXPECT_EQ(OrderOverLens(undefined, 1, 9).indices, (std::vector<size_t>{1, 3, 0, 2}));
}

TEST(LensOrder, PreferredPointsComeFirstUnlessTheyAreCrowded) {
  std::vector<Vec2> points;
  for (int i = 0; i < 50; ++i) points.push_back({0.001 * i, 0});  // preferred, and crowded
  for (const double x : {-1.0, 1.0}) points.push_back({x, 0});
  const std::vector<size_t> order = FarthestPointOrder(points, 4, 50);
  EXPECT_EQ(std::count(order.begin(), order.end(), 50), 1);
  EXPECT_EQ(std::count(order.begin(), order.end(), 51), 1);
  // If two points are nearly as far, the preferred one is chosen.
  const std::vector<Vec2> two = {{1, 0}, {0, 0}, {-1.2, 0}};
  EXPECT_EQ(FarthestPointOrder(two, 2, 1)[1], 0U);
  EXPECT_EQ(FarthestPointOrder(two, 2, 0)[1], 2U);
}

TEST(LensOrder, CountIsLimited) {
  EXPECT_TRUE(FarthestPointOrder({}, 5).empty());
  EXPECT_EQ(FarthestPointOrder(RandomPoints(9), 5).size(), 5U);
  const std::vector<Vec2> same(3, Vec2(1, 1));
  EXPECT_EQ(FarthestPointOrder(same, 9), (std::vector<size_t>{0, 1, 2}));
}

}  // namespace
}  // namespace lf
