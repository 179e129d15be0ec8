// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_depths.h"

#include <gtest/gtest.h>

#include <limits>

namespace lf {
namespace {

TEST(ColmapDepths, OnePercentLiesOutsideAtEitherEnd) {
  DepthSample sample;
  for (uint64_t i = 0; i <= 1000; ++i) sample.Add(i, 1, 1 + static_cast<double>(i) / 1000);
  EXPECT_EQ(sample.Range(), (DepthRange{1.01, 1.99}));
}

TEST(ColmapDepths, WhatLiesBehindACameraDoesNotCount) {
  DepthSample sample;
  sample.Add(1, 1, -2);
  sample.Add(2, 1, 0);
  sample.Add(3, 1, std::numeric_limits<double>::infinity());
  sample.Add(4, 1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(sample.Range(), std::nullopt);
  sample.Add(5, 1, 3);
  EXPECT_EQ(sample.Range(), (DepthRange{3, 3}));
}

// There are 2.5 times as many depths as the sample may keep.
TEST(ColmapDepths, TheOrderDoesNotMatter) {
  constexpr uint64_t kCount = 5 * DepthSample::kMaxCount / 2;
  const auto depth = [](uint64_t i) { return 1 + static_cast<double>(i) / kCount; };
  DepthSample forward, backward, asked;
  for (uint64_t i = 0; i < kCount; ++i) forward.Add(i, 7, depth(i));
  for (uint64_t i = kCount; i-- > 0;) backward.Add(i, 7, depth(i));
  for (uint64_t i = 0; i < kCount; ++i)
    if (asked.MayKeep(i, 7)) asked.Add(i, 7, depth(i));
  ASSERT_TRUE(forward.Range());
  EXPECT_EQ(forward.Range(), backward.Range());
  EXPECT_EQ(forward.Range(), asked.Range());
  EXPECT_NEAR(forward.Range()->near_w, 1.01, 0.001);
  EXPECT_NEAR(forward.Range()->far_w, 1.99, 0.001);
}

}  // namespace
}  // namespace lf
