// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/compare_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lf {
namespace {

constexpr int kSize = 40;
constexpr double kWhite = 1;

Intrinsics SmallCamera() {
  Intrinsics k;
  k.fx_px = k.fy_px = kSize;
  k.cx_px = k.cy_px = kSize / 2.;
  k.width_px = k.height_px = kSize;
  return k;
}

// Returns a view with this light in R, half of it in G, and a third in B. Negative light means that
// the pixel is not recorded.
ExposureView Draw(const std::function<double(int x, int y)>& light) {
  ExposureView view;
  view.grey = std::make_shared<const ReducedImage>();
  view.light = Image<uint16_t>(kSize, kSize, 3);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (int c = 0; c < 3; ++c)
        view.light.at(x, y, c) =
            light(x, y) < 0
                ? 0
                : static_cast<uint16_t>(std::lround(1 + kLightSteps * light(x, y) / (c + 1)));
  return view;
}

// Compares the patch in the middle of a with a patch of b that is displaced by `displaced_px`.
std::optional<ExposureSample> Compare(const ExposureView& a, const ExposureView& b,
                                      double displaced_px = 0) {
  const Intrinsics k = SmallCamera();
  Place place;
  place.at_px = Vec2(20.5, 20.5);
  const PatchGrid grid{Vec2(20.5 + displaced_px, 20.5), Vec2(1, 0), Vec2(0, 1)};
  return ComparedPatch({a, k}, place, kWhite).CompareWith({b, k}, grid);
}

double Stripes(int x, int) { return x / 4 % 2 == 0 ? 0.1 : 0.6; }

TEST(ComparedPatch, TheRatioIsThatOfTheExposures) {
  const ExposureView a = Draw(Stripes);
  const ExposureView b = Draw([](int x, int y) { return Stripes(x, y) / 1.25; });
  const auto sample = Compare(a, b);
  ASSERT_TRUE(sample);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(sample->log_ratio[c], std::log(1.25), 1e-4);
    EXPECT_LT(sample->deviation[c], 1e-3);
  }
  EXPECT_EQ(sample->a_r_squared, sample->b_r_squared);
}

TEST(ComparedPatch, BothImagesCountAlike) {
  const ExposureView a = Draw(Stripes);
  const ExposureView b = Draw([](int x, int y) { return 0.8 * Stripes(x + 3, y) + 0.001 * x; });
  const auto one = Compare(a, b), other = Compare(b, a);
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(one->log_ratio[1], -other->log_ratio[1], 1e-4);
  EXPECT_NEAR(one->a_r_squared, other->b_r_squared, 1e-4);
}

TEST(ComparedPatch, EdgesThatFallBetweenPixelsCountLittle) {
  const ExposureView a = Draw([](int x, int) { return x < 20 ? 0.1 : 0.6; });
  const ExposureView b = Draw([](int x, int) { return x < 20 ? 0.1 : x == 20 ? 0.3 : 0.6; });
  const auto sample = Compare(a, b);
  ASSERT_TRUE(sample);
  // The log ratio of the means over all pixels of the patches would be 0.06.
  EXPECT_NEAR(sample->log_ratio[0], 0, 0.002);
}

TEST(ComparedPatch, ADeviationTellsOfOtherLight) {
  const ExposureView a = Draw([](int, int) { return 0.4; });
  const ExposureView b = Draw([](int x, int y) { return (x * 7 + y * 3) % 5 == 0 ? 0.42 : 0.4; });
  EXPECT_GT(Compare(a, b)->deviation[0], 2 * Compare(a, a)->deviation[0]);
}

TEST(ComparedPatch, TheRadiiAreThoseOfThePlaces) {
  const ExposureView a = Draw([](int, int) { return 0.4; });
  const auto sample = Compare(a, a, 5);
  ASSERT_TRUE(sample);
  const double square = 2. * kSize * kSize / 4;  // square of half the diagonal
  const double own = 2 * 14 + 2 * 0.25;          // 14: variance of 13 consecutive numbers
  EXPECT_NEAR(sample->a_r_squared, own / square, 1e-6);
  EXPECT_NEAR(sample->b_r_squared, (2 * 14 + 0.25 + 5.5 * 5.5) / square, 1e-6);
  EXPECT_GT(sample->b_r_variance, sample->a_r_variance);
}

TEST(ComparedPatch, DarkAndUnrecordedPatchesTellNothing) {
  const ExposureView lit = Draw([](int, int) { return 0.4; });
  EXPECT_FALSE(Compare(lit, Draw([](int, int) { return 0.005; })));
  EXPECT_FALSE(Compare(lit, Draw([](int x, int) { return x % 3 == 0 ? -1 : 0.4; })));
  EXPECT_FALSE(Compare(lit, lit, 18));  // beyond the image
  // This light is too dark only in blue, of which Draw() draws a third of `light`.
  const auto sample = Compare(lit, Draw([](int, int) { return 0.025; }));
  ASSERT_TRUE(sample);
  EXPECT_FALSE(std::isnan(sample->log_ratio[0]));
  EXPECT_TRUE(std::isnan(sample->log_ratio[2]));
}

}  // namespace
}  // namespace lf
