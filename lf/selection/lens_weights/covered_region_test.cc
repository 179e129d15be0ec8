// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/covered_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

double AreaWithin(const CoveredRegion& region, double half_side) {
  ConvexPolygon square = ConvexPolygon::SquareAround(Vec2::Zero(), half_side);
  region.Clip(&square);
  return square.Area();
}

TEST(CoveredRegion, TheWholePlaneByDefault) {
  EXPECT_TRUE(CoveredRegion().Contains({1e9, -1e9}));
  EXPECT_DOUBLE_EQ(AreaWithin({}, 3), 36);
  EXPECT_TRUE(std::isinf(CoveredRegion().LargestRadius_w()));
}

TEST(CoveredRegion, AGridAndItsMargin) {
  std::vector<Vec2> grid;
  for (int i = 0; i < 121; ++i) grid.emplace_back(0.1 * (i % 11 - 5), 0.1 * (i / 11 - 5));
  const CoveredRegion region(grid, 0.1);
  EXPECT_TRUE(region.Contains({0.599, -0.599}));
  EXPECT_FALSE(region.Contains({0.601, 0}));
  EXPECT_NEAR(AreaWithin(region, 3), 1.44, 1e-12);
  EXPECT_NEAR(region.LargestRadius_w(), 0.6, 1e-12);
}

TEST(CoveredRegion, ATrackIsABand) {
  const std::vector<Vec2> track = {{0, 0}, {0.3, 0.3}, {1, 1}, {0.7, 0.7}};
  const CoveredRegion region(track, 0.1);
  EXPECT_NEAR(AreaWithin(region, 3), 0.2 * (std::sqrt(2) + 0.2), 1e-9);
  EXPECT_NEAR(region.LargestRadius_w(), 0.1, 1e-9);
}

TEST(CoveredRegion, OnePlaceIsASquare) {
  const std::vector<Vec2> place = {{2, 1}, {2, 1}};
  const CoveredRegion region(place, 0.5);
  EXPECT_NEAR(AreaWithin(region, 9), 1, 1e-12);
  EXPECT_EQ(region.LargestRadius_w(), 0);
}

TEST(CoveredRegion, ContainsEveryPointOfACloudAndNotMuchMore) {
  std::vector<Vec2> cloud;
  RandomSequence random(1);
  while (cloud.size() < 2000) {
    const Vec2 point(random.Uniform(-1, 1), random.Uniform(-1, 1));
    if (point.norm() <= 1) cloud.push_back(point);
  }
  const CoveredRegion region(cloud, 0);
  for (const Vec2& point : cloud) {
    EXPECT_TRUE(region.Contains(point * (1 - 1e-9)));
    EXPECT_FALSE(region.Contains(point.normalized() * 1.001));
  }
  EXPECT_NEAR(AreaWithin(region, 2), kPi, 0.1);
}

TEST(CoveredRegion, TellsHowFarAPlaceIsBeyondItsSides) {
  const std::vector<Vec2> square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const CoveredRegion region(square, 0.5);
  EXPECT_NEAR(region.Beyond_w({0, 0}), -1.5, 1e-12);
  EXPECT_NEAR(region.Beyond_w({1.25, 0.3}), -0.25, 1e-12);
  EXPECT_NEAR(region.Beyond_w({-4, 2}), 2.5, 1e-12);
  EXPECT_EQ(CoveredRegion().Beyond_w({9, 9}), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace lf
