// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/ordered_half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lf {
namespace {

TEST(OrderedHalf, EveryHalfComesBackInOrder) {
  float last = -std::numeric_limits<float>::infinity();
  for (uint32_t ordered = 0x03FF; ordered <= 0xFC00; ++ordered) {
    const float value = FloatOfOrdered(static_cast<uint16_t>(ordered));
    ASSERT_FALSE(std::isnan(value));
    ASSERT_GE(value, last);
    ASSERT_EQ(OrderedOfFloat(value), ordered);
    last = value;
  }
  EXPECT_EQ(last, std::numeric_limits<float>::infinity());
}

TEST(OrderedHalf, FloatsBetweenGoToTheNearest) {
  for (uint32_t half = 0; half < 0x7BFF; ++half) {
    const float low = FloatOfHalf(static_cast<uint16_t>(half));
    const float high = FloatOfHalf(static_cast<uint16_t>(half + 1));
    const float middle = (low + high) / 2;
    EXPECT_EQ(HalfOf(std::nextafter(middle, 0.f)), half);
    EXPECT_EQ(HalfOf(std::nextafter(middle, 1e9f)), half + 1);
    EXPECT_EQ(HalfOf(middle), half + half % 2);
    ASSERT_EQ(HalfOf(-middle), 0x8000 | (half + half % 2));
  }
}

TEST(OrderedHalf, KnownNumbers) {
  EXPECT_EQ(HalfOf(1), 0x3C00);
  EXPECT_EQ(HalfOf(-2), 0xC000);
  EXPECT_EQ(HalfOf(65504), 0x7BFF);
  EXPECT_EQ(HalfOf(65519.9f), 0x7BFF);
  EXPECT_EQ(HalfOf(65520), 0x7C00);
  EXPECT_EQ(HalfOf(1e30f), 0x7C00);
  EXPECT_EQ(HalfOf(1e-30f), 0);
  EXPECT_EQ(HalfOf(0x1p-24f), 1);
  EXPECT_EQ(HalfOf(0x1p-25f), 0);
  EXPECT_EQ(HalfOf(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(OrderedHalf, NothingGivesNan) {
  for (uint32_t ordered = 0; ordered <= 0xFFFF; ++ordered)
    ASSERT_FALSE(std::isnan(FloatOfOrdered(static_cast<uint16_t>(ordered))));
}

}  // namespace
}  // namespace lf
