// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/display_curve.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace lf {
namespace {

TEST(DisplayCurve, ValuesComeBackFinerThanAnyoneSees) {
  const struct { double black, white; } levels[] = {{0, 65535}, {1024, 65535}, {256, 16383}};
  for (const auto& [black, white] : levels) {
    const DisplayCurve curve(black, white);
    for (int value = 0; value <= 65535; ++value) {
      const auto stored = static_cast<uint16_t>(value);
      const int back = curve.Stored(curve.OnCurve(stored));
      // Rounding loses half a step of the curve in each direction.
      const int slack = value < black ? 3 : static_cast<int>(value / 8000) + 3;
      ASSERT_LE(std::abs(back - value), slack) << black << " to " << white << ": " << value;
      if (value > 0) {
        ASSERT_GE(curve.OnCurve(stored), curve.OnCurve(static_cast<uint16_t>(value - 1)));
      }
    }
  }
}

// The greys of a display have equal distances in shadows and in highlights.
TEST(DisplayCurve, GreyStepsAreEven) {
  const DisplayCurve curve(0, 65535);
  EXPECT_DOUBLE_EQ(curve.grey_step(), 257);
  // sRGB 0.5 is a linear light of 0.21404.
  EXPECT_NEAR(curve.OnCurve(14027), 65535 / 2.0, 2);
  EXPECT_EQ(curve.OnCurve(0), 0);
  EXPECT_EQ(curve.OnCurve(65535), 65535);
}

}  // namespace
}  // namespace lf
