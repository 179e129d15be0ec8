// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/compare_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lf/core/random.h"
#include "lf/film/compare/difference_picture.h"
#include "lf/film/compare/ssim.h"
#include "lf/film/develop/display.h"

namespace lf {
namespace {

PictureLight Noise(int width, int height, uint64_t seed, float scale = 1) {
  PictureLight picture{.rgb = Image<float>(width, height, 3), .coverage = {}};
  for (size_t i = 0; i < picture.rgb.pixels().size(); ++i)
    picture.rgb.pixels()[i] = scale * static_cast<float>(RandomUnit(seed, 1, i));
  return picture;
}

PictureLight Flat(int width, int height, float value) {
  return {.rgb = Image<float>(width, height, 3, value), .coverage = {}};
}

PictureDifference Difference(const PictureLight& a, const PictureLight& b,
                             const CompareOptions& options = {}, int threads = 2) {
  ThreadPool pool(threads);
  const auto comparison = ComparePictures(a, b, options, pool);
  EXPECT_TRUE(comparison) << comparison.error().message;
  return comparison->difference;
}

TEST(ComparePictures, EqualPicturesDoNotDiffer) {
  const PictureLight picture = Noise(40, 30, 1);
  const PictureDifference difference = Difference(picture, picture);
  EXPECT_EQ(difference.PsnrDb(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(difference.LinearPsnrDb(), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(difference.Ssim(), 1, 1e-6);
  EXPECT_EQ(difference.Flip(), 0);
  EXPECT_EQ(difference.pixel_count, 1200);
}

TEST(ComparePictures, FlatPicturesHaveTheFormulas) {
  const double a = 0.25, b = 0.5;
  const PictureDifference difference = Difference(Flat(32, 32, 0.25f), Flat(32, 32, 0.5f));
  EXPECT_NEAR(difference.LinearPsnrDb(), -20 * std::log10(b - a), 1e-6);
  const double p = DisplayFromLinear(a), q = DisplayFromLinear(b);
  EXPECT_NEAR(difference.PsnrDb(), -20 * std::log10(q - p), 1e-5);
  EXPECT_NEAR(difference.Ssim(), (2 * p * q + 1e-4) / (p * p + q * q + 1e-4), 1e-5);
  // Without structure only the lightness of CIELAB differs. The distance of green and blue, which
  // the range is measured by, is 203.32.
  const double distance = std::pow(116 * (std::cbrt(b) - std::cbrt(a)), 0.7);
  const double largest = std::pow(203.32, 0.7);
  EXPECT_LT(distance, 0.4 * largest);
  EXPECT_NEAR(difference.Flip(), distance * 0.95 / (0.4 * largest), 2e-4);
}

TEST(ComparePictures, WhiteAgainstBlackIsTheLargestDifferenceOfFlatPictures) {
  const double flip = Difference(Flat(32, 32, 1), Flat(32, 32, 0)).Flip();
  EXPECT_GT(flip, 0.95);
  EXPECT_LE(flip, 1);
}

TEST(ComparePictures, LightAboveWhiteCountsOnlyInLinearLight) {
  const PictureDifference difference = Difference(Flat(16, 16, 1), Flat(16, 16, 3));
  EXPECT_NEAR(difference.LinearPsnrDb(), -20 * std::log10(2), 1e-9);
  EXPECT_EQ(difference.PsnrDb(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(difference.Flip(), 0);
}

TEST(ComparePictures, ShiftedEdgesAreSeenByFlipAndSsim) {
  PictureLight sharp = Flat(64, 64, 0.1f), shifted = sharp;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) {
        sharp.rgb.at(x, y, c) = x < 32 ? 0.1f : 0.6f;
        shifted.rgb.at(x, y, c) = x < 34 ? 0.1f : 0.6f;
      }
  const PictureDifference difference = Difference(sharp, shifted);
  EXPECT_GT(difference.Flip(), 0.02);
  EXPECT_LT(difference.Ssim(), 0.95);
  ThreadPool pool(1);
  const auto comparison = ComparePictures(sharp, shifted, {}, pool);
  EXPECT_GT(comparison->flip.at(33, 32), 0.5);
  EXPECT_LT(comparison->flip.at(4, 32), 1e-3);
}

TEST(ComparePictures, SumsDoNotDependOnThreads) {
  const PictureLight a = Noise(61, 47, 1), b = Noise(61, 47, 2);
  const PictureDifference one = Difference(a, b, {}, 1);
  for (const int threads : {2, 3}) {
    const PictureDifference other = Difference(a, b, {}, threads);
    EXPECT_EQ(one.display_squares, other.display_squares);
    EXPECT_EQ(one.ssim_sum, other.ssim_sum);
    EXPECT_EQ(one.flip_sum, other.flip_sum);
  }
}

TEST(ComparePictures, BordersUndefinedValuesAndUncoveredPixelsDoNotCount) {
  PictureLight a = Flat(20, 10, 0.5f), b = a;
  b.rgb.at(0, 0, 1) = 1;
  b.rgb.at(7, 5, 2) = std::numeric_limits<float>::quiet_NaN();
  a.rgb.at(9, 5, 0) = std::numeric_limits<float>::infinity();
  b.coverage.emplace(20, 10, 1, 1.0f);
  b.coverage->at(12, 4) = 0.25f;
  const PictureDifference difference = Difference(a, b, {.border = 1, .min_coverage = 0.5});
  EXPECT_EQ(difference.pixel_count, 18 * 8 - 3);
  EXPECT_EQ(difference.undefined_count, 2);
  EXPECT_EQ(difference.linear_squares, 0);
}

TEST(ComparePictures, BadPairsAreErrors) {
  ThreadPool pool(1);
  const auto sizes = ComparePictures(Flat(8, 8, 0), Flat(8, 9, 0), {}, pool);
  ASSERT_FALSE(sizes);
  EXPECT_EQ(sizes.error().message, "has 8 x 9 pixels, expected 8 x 8 as the reference");
  const auto nothing = ComparePictures(Flat(8, 8, 0), Flat(8, 8, 0), {.border = 4}, pool);
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().message.find("no pixel can be compared"), std::string::npos);
}

TEST(DifferencePicture, GreyWhereEqualAndBrighterWhereTheTestIs) {
  PictureLight a = Flat(2, 1, 0.25f), b = a;
  b.rgb.at(1, 0, 0) = 1;
  const Image<uint8_t> picture = SignedDifferencePicture(a, b, 1);
  EXPECT_EQ(picture.at(0, 0, 0), 128);
  EXPECT_EQ(picture.at(1, 0, 0), std::lround(255 * (0.5 + 0.5 * (1 - DisplayFromLinear(0.25)))));
  EXPECT_EQ(picture.at(1, 0, 1), 128);
  Image<float> flip(3, 1);
  flip.at(1, 0) = 0.5f;
  flip.at(2, 0) = 1;
  const Image<uint8_t> colours = FlipPicture(flip);
  EXPECT_LT(colours.at(0, 0, 0), colours.at(1, 0, 0));
  EXPECT_LT(colours.at(1, 0, 1), colours.at(2, 0, 1));
}

}  // namespace
}  // namespace lf
