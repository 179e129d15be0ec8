// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/spread_sequence.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace lf {
namespace {

// True if each of 2^m equal rectangles has exactly `expected` of the points, for every shape of the
// rectangles.
bool IsNet(const std::vector<SpreadPoint>& points, int m, size_t expected) {
  for (int a = 0; a <= m; ++a) {
    std::vector<size_t> counts(size_t{1} << m, 0);
    for (const SpreadPoint& point : points) {
      const uint64_t column = uint64_t{point.x} >> (32 - a);
      const uint64_t row = uint64_t{point.y} >> (32 - (m - a));
      ++counts[(column << (m - a)) + row];
    }
    for (const size_t count : counts)
      if (count != expected) return false;
  }
  return true;
}

std::vector<SpreadPoint> Part(const std::vector<SpreadPoint>& all, size_t begin, size_t count,
                              size_t step = 1) {
  std::vector<SpreadPoint> part;
  for (size_t i = 0; i < count; ++i) part.push_back(all[begin + i * step]);
  return part;
}

TEST(SpreadSequence, EachAlignedBlockHasOnePointInEachRectangle) {
  for (const uint64_t seed : {0, 1, 77}) {
    const std::vector<SpreadPoint> all = SpreadSequence(4096, seed);
    for (int m = 0; m <= 10; ++m)
      for (size_t block = 0; block < 4; ++block)
        EXPECT_TRUE(IsNet(Part(all, block << m, size_t{1} << m), m, 1))
            << "seed " << seed << ", block " << block << " of 2^" << m;
  }
  // In any other block of 2^m points, some rectangle is missed.
  EXPECT_FALSE(IsNet(Part(SpreadSequence(100, 0), 3, 64), 6, 1));
}

// A (2,m,2)-net: each rectangle of four points' area has four points.
TEST(SpreadSequence, EverySecondToSixteenthPointIsSpread) {
  const std::vector<SpreadPoint> all = SpreadSequence(4096, 5);
  for (const size_t step : {2, 4, 8, 16})
    for (size_t first = 0; first < step; ++first)
      for (int m = 2; m <= 6; ++m)
        EXPECT_TRUE(IsNet(Part(all, first, size_t{1} << m, step), m - 2, 4))
            << "every " << step << "th from " << first << " on, 2^" << m;
}

TEST(SpreadSequence, ALongerSequenceBeginsWithAShorterOne) {
  const std::vector<SpreadPoint> all = SpreadSequence(100, 5), few = SpreadSequence(37, 5);
  for (size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].x, all[i].x);
    EXPECT_EQ(few[i].y, all[i].y);
  }
  EXPECT_TRUE(SpreadSequence(0, 5).empty());
}

TEST(SpreadSequence, SeedsAndStreamsGiveOtherPoints) {
  std::set<std::pair<uint32_t, uint32_t>> seen;
  for (const uint64_t seed : {0, 1, 2})
    for (const uint64_t stream : {0, 1}) {
      const SpreadPoint point = SpreadSequence(8, seed, stream)[7];
      EXPECT_TRUE(seen.emplace(point.x, point.y).second);
    }
}

// Frames depend on these points, so that they must be the same in all versions and on all machines.
// A Python program computed the numbers by the definition.
TEST(SpreadSequence, PointsAreThoseOfAllMachines) {
  const std::vector<SpreadPoint> points = SpreadSequence(1000, 3);
  const std::vector<SpreadPoint> others = SpreadSequence(12346, 3, 1);
  EXPECT_EQ(points[0].x, 761344358U);
  EXPECT_EQ(points[0].y, 2699532519U);
  EXPECT_EQ(points[1].x, 4099015268U);
  EXPECT_EQ(points[1].y, 1070216070U);
  EXPECT_EQ(points[999].x, 800307702U);
  EXPECT_EQ(points[999].y, 3919261044U);
  EXPECT_EQ(others[12345].x, 3560921894U);
  EXPECT_EQ(others[12345].y, 3847367864U);
}

}  // namespace
}  // namespace lf
