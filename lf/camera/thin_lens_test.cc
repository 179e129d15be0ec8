// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/thin_lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lf {
namespace {

TEST(ThinLens, TwiceTheFocalLengthIsImagedAtTwiceTheFocalLength) {
  EXPECT_DOUBLE_EQ(*ImageDistance(0.05, 0.1), 0.1);
  EXPECT_DOUBLE_EQ(*ImageDistance(0.05, std::numeric_limits<double>::infinity()), 0.05);
}

TEST(ThinLens, ObeysTheLensLaw) {
  for (const double g : {0.06, 0.2, 1.0, 50.0})
    EXPECT_NEAR(1 / 0.05, 1 / g + 1 / *ImageDistance(0.05, g), 1e-9);
}

TEST(ThinLens, FocusWithinTheFocalLengthIsAnError) {
  EXPECT_FALSE(ImageDistance(0.05, 0.05));
  EXPECT_FALSE(ImageDistance(0, 1));
  EXPECT_FALSE(ImageDistance(0.05, std::nan("")));
}

TEST(ThinLens, BlurReachesItsLimitAtTheEndsOfTheDepthOfField) {
  const DepthRange range = DepthOfField(0.02, 2, 0.001);
  EXPECT_LT(range.near_w, 2);
  EXPECT_GT(range.far_w, 2);
  EXPECT_NEAR(BlurOnFocusPlane(0.02, 2, range.near_w), 0.001, 1e-12);
  EXPECT_NEAR(BlurOnFocusPlane(0.02, 2, range.far_w), 0.001, 1e-12);
  EXPECT_EQ(BlurOnFocusPlane(0.02, 2, 2), 0);
}

TEST(ThinLens, TheFNumberIsFocalLengthOverDiameter) {
  EXPECT_DOUBLE_EQ(FNumber(0.05, 0.025), 2);
  EXPECT_DOUBLE_EQ(FNumber(0.085, 0.0302), 0.085 / 0.0302);
  EXPECT_TRUE(std::isinf(FNumber(0.05, 0)));
  // One stop multiplies N by sqrt(2) and halves the area of the opening (thesis 2.2.6).
  const double d = 0.02, stopped_down = 0.05 / (std::sqrt(2.0) * FNumber(0.05, d));
  EXPECT_NEAR(stopped_down * stopped_down / (d * d), 0.5, 1e-12);
}

// The blur is d / b |b - b_plate| on the plate (thesis Eq. 2.9), where b is the distance at which
// the point is imaged sharply; one unit on the plate corresponds to g / b_plate on the focus plane.
TEST(ThinLens, BlurIsTheCircleOfConfusionSeenOnTheFocusPlane) {
  const double f = 0.05, d = 0.02;
  for (const double g : {0.3, 2.0})
    for (const double depth : {0.1, 0.29, 1.0, 2.5, 100.0}) {
      const double b = 1 / (1 / f - 1 / depth), b_plate = 1 / (1 / f - 1 / g);
      const double on_plate = d / b * std::abs(b - b_plate);
      EXPECT_NEAR(BlurOnFocusPlane(d, g, depth), on_plate * g / b_plate, 1e-12);
    }
}

// For g >> f, each end of the depth of field is r f g^2 / (d f^2) from the focus plane, where r is
// the size of a pixel on the plate (thesis Eq. 2.10).
TEST(ThinLens, TheDepthOfFieldComesNearTheThesissApproximation) {
  const double f = 0.05, d = 0.02, g = 5, pixel = 2e-6;
  const double approximation = pixel * f * g * g / (d * f * f);
  const double limit = pixel * g / *ImageDistance(f, g);  // size of a pixel on the focus plane
  const DepthRange range = DepthOfField(d, g, limit);
  EXPECT_NEAR(g - range.near_w, approximation, 0.03 * approximation);
  EXPECT_NEAR(range.far_w - g, approximation, 0.03 * approximation);
}

TEST(ThinLens, PinholesAndSmallLensesAreSharpToInfinity) {
  EXPECT_TRUE(std::isinf(DepthOfField(0, 2, 0.001).far_w));
  EXPECT_TRUE(std::isinf(DepthOfField(0.001, 2, 0.001).far_w));
}

}  // namespace
}  // namespace lf
