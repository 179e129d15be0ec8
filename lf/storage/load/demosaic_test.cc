// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/demosaic.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "lf/core/random.h"

namespace lf {
namespace {

using Balance = std::array<double, 3>;
constexpr Balance kBalanced = {1, 1, 1};
constexpr std::array kPatterns = {BayerPattern::kRggb, BayerPattern::kBggr, BayerPattern::kGrbg,
                                  BayerPattern::kGbrg};

// Returns a mosaic whose pixels are value_of(x, y, channel).
template <class ValueOf>
LfPixels MosaicOf(int width, int height, BayerPattern bayer, const ValueOf& value_of) {
  LfPixels mosaic({0, 0, width, height}, bayer);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      mosaic.radiance.at(x, y) = static_cast<uint16_t>(value_of(x, y, BayerChannel(bayer, x, y)));
  return mosaic;
}

// Returns noise of which half of the pixels are 0 or 65535, so that sums reach their limits and
// colours exceed them.
LfPixels NoiseMosaic(int width, int height, BayerPattern bayer, uint64_t seed) {
  return MosaicOf(width, height, bayer, [&](int x, int y, int /*channel*/) {
    const uint64_t bits = RandomBits(seed, static_cast<uint64_t>(x), static_cast<uint64_t>(y));
    return (bits >> 16 & 1) == 0 ? bits & 0xffff : (bits >> 17 & 1) * 65535;
  });
}

// Returns the pixels `rect` of `whole`, as a store loads them.
LfPixels PartOf(const LfPixels& whole, const PixelRect& rect) {
  LfPixels part(rect, whole.bayer);
  for (int y = 0; y < rect.height(); ++y)
    for (int x = 0; x < rect.width(); ++x) {
      part.radiance.at(x, y) = whole.radiance.at(rect.x_begin + x, rect.y_begin + y);
      if (whole.IsMasked(rect.x_begin + x, rect.y_begin + y)) part.Mask(x, y);
    }
  return part;
}

LfPixels RgbOf(const LfPixels& mosaic, const Balance& white_balance) {
  LfPixels rgb;
  Demosaic(mosaic, mosaic.rect.width(), mosaic.rect.height(), white_balance, mosaic.rect, &rgb);
  return rgb;
}

void ExpectSame(const LfPixels& a, const LfPixels& b) {
  EXPECT_EQ(a.rect, b.rect);
  EXPECT_EQ(a.bayer, b.bayer);
  EXPECT_EQ(a.recorded, b.recorded);
  EXPECT_EQ(a.any_masked, b.any_masked);
  EXPECT_EQ(a.radiance.pixels(), b.radiance.pixels());
}

int Between(int begin, int end, uint64_t seed, uint64_t stream) {
  return begin + static_cast<int>(RandomBits(seed, stream, 0) % static_cast<uint64_t>(end - begin));
}

PixelRect RandomRect(int width, int height, uint64_t seed) {
  const int x = Between(0, width, seed, 1), y = Between(0, height, seed, 2);
  return {x, y, Between(x, width, seed, 3) + 1, Between(y, height, seed, 4) + 1};
}

// Compares Demosaic() with the reference in rectangles of small and of wide images. Some of the
// images have masked pixels. The ratios of the white balance lie within and beyond the limit.
void CompareWithReference() {
  LfPixels rgb, reference;  // reused for all images
  for (uint64_t seed = 0; seed < 400; ++seed) {
    const int width = Between(2, seed % 4 == 0 ? 150 : 9, seed, 5);
    const int height = Between(2, 9, seed, 6);
    LfPixels whole = NoiseMosaic(width, height, kPatterns[seed % 4], seed);
    for (int i = seed % 3 == 0 ? 2 : 0; i > 0; --i)
      whole.Mask(Between(0, width, seed + i, 7), Between(0, height, seed + i, 8));
    const PixelRect rect = RandomRect(width, height, seed);
    const LfPixels mosaic = PartOf(whole, MosaicRectOf(rect, width, height));
    Balance white_balance = {2, 1, 1.5};
    for (double& factor : white_balance)
      if (seed % 5 != 0) factor = 0.1 + 4 * RandomUnit(seed, 9, static_cast<uint64_t>(factor * 2));
    Demosaic(mosaic, width, height, white_balance, rect, &rgb);
    DemosaicReference(mosaic, width, height, white_balance, rect, &reference);
    SCOPED_TRACE(seed);
    ExpectSame(rgb, reference);
  }
}

TEST(Demosaic, EqualsTheReferenceOnEveryInstructionSet) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    SCOPED_TRACE(hwy::TargetName(target));
    CompareWithReference();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

TEST(Demosaic, TheCutIntoRectanglesDoesNotMatter) {
  constexpr int kMosaicWidth = 23, kMosaicHeight = 14;
  const Balance white_balance = {2.3, 1, 1.4};
  for (const BayerPattern bayer : kPatterns) {
    LfPixels mosaic = NoiseMosaic(kMosaicWidth, kMosaicHeight, bayer, 1);
    mosaic.Mask(9, 6);
    const LfPixels whole = RgbOf(mosaic, white_balance);
    for (uint64_t seed = 0; seed < 50; ++seed) {
      const PixelRect rect = RandomRect(kMosaicWidth, kMosaicHeight, seed);
      LfPixels rgb;
      Demosaic(PartOf(mosaic, MosaicRectOf(rect, kMosaicWidth, kMosaicHeight)), kMosaicWidth,
               kMosaicHeight, white_balance, rect, &rgb);
      for (int y = rect.y_begin; y < rect.y_end; ++y)
        for (int x = rect.x_begin; x < rect.x_end; ++x)
          for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
            ASSERT_EQ(rgb.radiance.at(x - rect.x_begin, y - rect.y_begin, lane),
                      whole.radiance.at(x, y, lane));
    }
  }
}

TEST(Demosaic, NeedsTwoPixelsMoreWithinTheImage) {
  EXPECT_EQ(MosaicRectOf({5, 6, 8, 9}, 20, 20), (PixelRect{3, 4, 10, 11}));
  EXPECT_EQ(MosaicRectOf({1, 0, 19, 20}, 20, 20), (PixelRect{0, 0, 20, 20}));
  EXPECT_TRUE(MosaicRectOf({}, 20, 20).empty());
  LfPixels rgb({0, 0, 3, 3}, BayerPattern::kNone);
  Demosaic(LfPixels({}, BayerPattern::kRggb), 20, 20, kBalanced, {}, &rgb);
  EXPECT_TRUE(rgb.radiance.empty());
}

// A constant stays constant, so a pedestal survives.
TEST(Demosaic, WhatIsConstantStaysConstant) {
  for (const BayerPattern bayer : kPatterns)
    for (const Balance& white_balance : {kBalanced, Balance{2.1, 1, 1.7}, Balance{1, 30, 0.01}})
      for (const int value : {0, 1024, 65535}) {
        const LfPixels rgb =
            RgbOf(MosaicOf(7, 6, bayer, [&](int, int, int) { return value; }), white_balance);
        for (int y = 0; y < 6; ++y)
          for (int x = 0; x < 7; ++x)
            for (int channel = 0; channel < 3; ++channel)
              ASSERT_EQ(rgb.radiance.at(x, y, channel), value);
      }
}

// Every colour has its own ramp.
TEST(Demosaic, LinearRampsAreExactAwayFromBorders) {
  constexpr int kSize = 40;
  const auto ramp = [](int x, int y, int channel) {
    return 1000 + 2000 * channel + (3 + 7 * channel) * x + (11 - 4 * channel) * y;
  };
  for (const BayerPattern bayer : kPatterns) {
    const LfPixels rgb = RgbOf(MosaicOf(kSize, kSize, bayer, ramp), {1.9, 1, 1.3});
    for (int y = 2; y < kSize - 2; ++y)
      for (int x = 2; x < kSize - 2; ++x)
        for (int channel = 0; channel < 3; ++channel)
          ASSERT_EQ(rgb.radiance.at(x, y, channel), ramp(x, y, channel));
  }
}

TEST(Demosaic, GainsAreThePapersTimesTheRatioOfTheWhiteBalance) {
  const auto at_spot = [](int x, int y, const Balance& white_balance, int channel) {
    const LfPixels mosaic = MosaicOf(12, 12, BayerPattern::kRggb, [&](int column, int row, int) {
      return column == x && row == y ? 800 : 0;
    });
    return RgbOf(mosaic, white_balance).radiance.at(x, y, channel);
  };
  EXPECT_EQ(at_spot(6, 6, kBalanced, 1), 400);  // G at R
  EXPECT_EQ(at_spot(6, 6, kBalanced, 2), 600);  // B at R
  EXPECT_EQ(at_spot(5, 6, kBalanced, 0), 500);  // R at G
  EXPECT_EQ(at_spot(5, 6, kBalanced, 2), 500);
  EXPECT_EQ(at_spot(6, 6, {2, 1, 1.5}, 1), 800);
  EXPECT_EQ(at_spot(5, 6, {2, 1, 1.5}, 0), 250);
  EXPECT_EQ(at_spot(6, 6, {3, 1, 1.5}, 2), 1200);
}

// Except for rounding, it makes no difference whether the pixels are white balanced before or after
// demosaicing, because Demosaic() takes the white balance into account.
TEST(Demosaic, WhiteBalanceMayComeAfterwards) {
  constexpr int kSize = 30;
  const std::array<int, 3> factors = {4, 1, 2};
  const auto balanced = [](int x, int y, int /*channel*/) {
    const auto bits = RandomBits(3, static_cast<uint64_t>(x), static_cast<uint64_t>(y));
    return static_cast<int>(20000 + bits % 1000 * 4);
  };
  const auto recorded = [&](int x, int y, int channel) {
    return balanced(x, y, channel) / factors[static_cast<size_t>(channel)];
  };
  for (const BayerPattern bayer : kPatterns) {
    const LfPixels before = RgbOf(MosaicOf(kSize, kSize, bayer, balanced), kBalanced);
    const LfPixels after = RgbOf(MosaicOf(kSize, kSize, bayer, recorded), {4, 1, 2});
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int channel = 0; channel < 3; ++channel) {
          const int factor = factors[static_cast<size_t>(channel)];
          ASSERT_NEAR(after.radiance.at(x, y, channel) * factor, before.radiance.at(x, y, channel),
                      factor / 2 + 1);
        }
  }
}

// Compares an image with a larger one that contains it and its mirrored surroundings, in which the
// inner pixels are away from the border.
TEST(Demosaic, BordersAreMirroredAboutTheOutermostPixels) {
  for (const BayerPattern bayer : kPatterns)
    for (const auto& size : {std::pair(2, 2), std::pair(3, 2), std::pair(8, 5)}) {
      const int width = size.first, height = size.second;
      const LfPixels small = NoiseMosaic(width, height, bayer, 2);
      const auto inside = [](int position, int side) {
        const int period = 2 * (side - 1), phase = (position + 2 * period) % period;
        return phase < side ? phase : period - phase;
      };
      const LfPixels large =
          MosaicOf(width + 4, height + 4, bayer, [&](int x, int y, int /*channel*/) {
            return small.radiance.at(inside(x - 2, width), inside(y - 2, height));
          });
      const LfPixels rgb = RgbOf(small, {1.5, 1, 2}), rgb_large = RgbOf(large, {1.5, 1, 2});
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
            ASSERT_EQ(rgb.radiance.at(x, y, lane), rgb_large.radiance.at(x + 2, y + 2, lane));
    }
}

TEST(Demosaic, AMaskedPixelMasksWhatIsMadeFromIt) {
  LfPixels mosaic = NoiseMosaic(9, 9, BayerPattern::kGrbg, 4);
  EXPECT_FALSE(RgbOf(mosaic, kBalanced).any_masked);
  mosaic.Mask(4, 3);
  const LfPixels rgb = RgbOf(mosaic, kBalanced);
  EXPECT_TRUE(rgb.any_masked);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x)
      EXPECT_EQ(rgb.IsMasked(x, y), std::abs(x - 4) + std::abs(y - 3) <= 2) << x << ", " << y;
  // The masked pixel is in a corner of the loaded part, too far away to mask a pixel of the result.
  LfPixels part;
  Demosaic(PartOf(mosaic, {4, 3, 9, 9}), 9, 9, kBalanced, {6, 5, 9, 9}, &part);
  EXPECT_FALSE(part.any_masked);
}

}  // namespace
}  // namespace lf
