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

TEST(ThinLens, PinholesAndSmallLensesAreSharpToInfinity) {
  EXPECT_TRUE(std::isinf(DepthOfField(0, 2, 0.001).far_w));
  EXPECT_TRUE(std::isinf(DepthOfField(0.001, 2, 0.001).far_w));
  EXPECT_TRUE(std::isinf(FNumber(0.05, 0)));
  EXPECT_DOUBLE_EQ(FNumber(0.05, 0.025), 2);
}

}  // namespace
}  // namespace lf
