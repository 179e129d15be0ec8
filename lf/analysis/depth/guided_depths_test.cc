// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/guided_depths.h"

#include <gtest/gtest.h>

#include <utility>

namespace lf {
namespace {

constexpr int kSize = 48;
constexpr float kHigh = 0.9f;
constexpr uint16_t kDark = 10000, kBright = 60000;

// A bright surface at index 5 fills the left half, the right one is dark and has no depth.
SweptMap HalfMap() {
  SweptMap map(kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const bool is_surface = x < kSize / 2;
      map.index.at(x, y) = 5;
      map.confidence.at(x, y) = is_surface ? kHigh : 0.1f;
      for (int c = 0; c < 3; ++c) map.roots.at(x, y, c) = is_surface ? kBright : kDark;
    }
  return map;
}

bool IsKnown(const SweptMap& map, int x, int y) { return map.confidence.at(x, y) >= 0.5f; }

TEST(GuidedDepths, ARimThatHasTheColourOfAPlaceWithoutDepthIsDoubted) {
  SweptMap map = HalfMap();
  for (int y = 0; y < kSize; ++y)
    for (const int x : {kSize / 2, kSize / 2 + 1}) map.confidence.at(x, y) = kHigh;
  ThreadPool pool(1);
  DoubtLonelyDepths({}, pool, &map);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) EXPECT_EQ(IsKnown(map, x, y), x < kSize / 2) << x << " " << y;
}

TEST(GuidedDepths, ThreadsChangeNoBit) {
  SweptMap one = HalfMap();
  for (size_t i = 0; i < one.index.pixels().size(); ++i) {
    one.index.pixels()[i] = static_cast<float>(i * 7919 % 13);
    one.roots.pixels()[3 * i] = static_cast<uint16_t>(i * 104729 % 65536);
  }
  SweptMap three = one;
  for (const auto& [map, threads] : {std::pair(&one, 1), std::pair(&three, 3)}) {
    ThreadPool pool(threads);
    DoubtLonelyDepths({}, pool, map);
    MendDepths({}, pool, map);
  }
  EXPECT_EQ(one.index.pixels(), three.index.pixels());
  EXPECT_EQ(one.confidence.pixels(), three.confidence.pixels());
}

TEST(GuidedDepths, HolesAndWrongDepthsAreMendedAndRightOnesKeepTheirBits) {
  SweptMap map = HalfMap();
  map.index.at(10, 10) = 17;                                  // wrong
  map.confidence.at(14, 30) = map.confidence.at(15, 30) = 0;  // missing
  map.index.at(8, 40) = 5.25f;                                // right
  const SweptMap before = map;
  ThreadPool pool(2);
  MendDepths({}, pool, &map);
  EXPECT_EQ(map.index.at(10, 10), 5);
  EXPECT_TRUE(IsKnown(map, 14, 30) && IsKnown(map, 15, 30));
  EXPECT_EQ(map.index.at(14, 30), 5);
  EXPECT_EQ(map.index.at(8, 40), 5.25f);
  EXPECT_NEAR(map.confidence.at(14, 30), kHigh, 1e-6);
  // The place without depth and the edge stay as they were.
  for (int y = 0; y < kSize; ++y)
    for (int x = kSize / 2; x < kSize; ++x) EXPECT_FALSE(IsKnown(map, x, y)) << x << " " << y;
}

TEST(GuidedDepths, AMedianKeepsTheEdgeBetweenTwoSurfaces) {
  SweptMap map = HalfMap();
  for (int y = 0; y < kSize; ++y)
    for (int x = kSize / 2; x < kSize; ++x) {
      map.index.at(x, y) = 15;
      map.confidence.at(x, y) = kHigh;
    }
  map.index.at(kSize / 2, 20) = 5;       // the far surface has a near depth
  map.index.at(kSize / 2 - 1, 30) = 15;  // and the near one a far depth
  ThreadPool pool(1);
  DoubtLonelyDepths({}, pool, &map);
  EXPECT_FALSE(IsKnown(map, kSize / 2, 20));
  MendDepths({}, pool, &map);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      EXPECT_TRUE(IsKnown(map, x, y));
      EXPECT_EQ(map.index.at(x, y), x < kSize / 2 ? 5 : 15) << x << " " << y;
    }
}

}  // namespace
}  // namespace lf
