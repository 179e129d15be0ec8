// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/display.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/core/random.h"

namespace lf {
namespace {

TEST(Display, KnownValuesOfTheStandard) {
  EXPECT_DOUBLE_EQ(DisplayFromLinear(0), 0);
  EXPECT_NEAR(DisplayFromLinear(1), 1, 1e-12);
  EXPECT_NEAR(DisplayFromLinear(0.18), 0.4613561, 1e-6);
  EXPECT_NEAR(DisplayFromLinear(0.001), 0.01292, 1e-12);
  for (double value = -0.1; value < 1.2; value += 0.01)
    EXPECT_NEAR(DisplayFromLinear(LinearFromDisplay(value)), value, 3e-5);
}

TEST(Display, EightBitsAreTheNearestStep) {
  const Display8 display8;
  for (uint64_t i = 0; i < 200000; ++i) {
    const auto linear = static_cast<float>(1.1 * RandomUnit(1, 1, i) - 0.05);
    const double exact = 255 * DisplayFromLinear(linear);
    const double expected = std::clamp(std::floor(exact + 0.5), 0.0, 255.0);
    // Very close to a half, float rounding decides: either neighbour is right.
    if (std::abs(exact - std::floor(exact) - 0.5) < 1e-4) continue;
    ASSERT_EQ(display8(linear), expected) << linear;
  }
  for (int i = 0; i < 256; ++i)
    EXPECT_EQ(display8(static_cast<float>(LinearFromDisplay(i / 255.0))), i);
  EXPECT_EQ(display8(NAN), 0);
  EXPECT_EQ(display8(INFINITY), 255);
  EXPECT_EQ(display8(-INFINITY), 0);
}

}  // namespace
}  // namespace lf
