// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/demosaic.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

using Balance = std::array<double, 3>;
constexpr Balance kBalanced = {1, 1, 1};
constexpr double kPedestal = 4096;

RadianceEncoding EncodingOf(const Balance& white_balance, double pedestal = kPedestal,
                            double max_radiance = 1) {
  RadianceEncoding encoding;
  encoding.white_balance = white_balance;
  encoding.pedestal = pedestal;
  encoding.max_radiance = max_radiance;
  return encoding;
}
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

// Returns noise of which half of the pixels are 0 or 65535, so that colours exceed both limits.
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

LfPixels RgbOf(const LfPixels& mosaic, const RadianceEncoding& encoding) {
  LfPixels rgb;
  Demosaic(mosaic, mosaic.rect.width(), mosaic.rect.height(), encoding, mosaic.rect, &rgb);
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

// Returns a smooth picture, so that gradients are small and no weight stands out.
LfPixels SmoothMosaic(int width, int height, BayerPattern bayer, uint64_t seed) {
  const double phase = RandomUnit(seed, 10, 0) * 6;
  return MosaicOf(width, height, bayer, [&](int x, int y, int channel) {
    return 9000 + 4000 * std::sin(0.3 * x + phase) * std::cos(0.2 * y) + 900 * channel;
  });
}

void Mask(LfPixels* mosaic, uint64_t seed) {
  const int width = mosaic->rect.width(), height = mosaic->rect.height();
  if (seed % 3 == 0)
    for (uint64_t i = 0; i < 2; ++i)
      mosaic->Mask(Between(0, width, seed + i, 7), Between(0, height, seed + i, 8));
  if (seed % 7 == 0) {  // a rectangle, in which pixels have no unmasked neighbours
    const PixelRect masked = RandomRect(width, height, seed + 1000);
    for (int y = masked.y_begin; y < masked.y_end; ++y)
      for (int x = masked.x_begin; x < masked.x_end; ++x) mosaic->Mask(x, y);
  }
}

// Compares Demosaic() with the reference in rectangles of small, of wide and of high images.
void CompareWithReference() {
  LfPixels rgb, reference;  // reused for all images
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    const int width = Between(2, seed % 4 == 0 ? 90 : 9, seed, 5);
    const int height = Between(2, seed % 4 == 1 ? 60 : 9, seed, 6);
    const BayerPattern bayer = kPatterns[seed / 2 % 4];
    LfPixels whole = seed % 2 == 0 ? NoiseMosaic(width, height, bayer, seed)
                                   : SmoothMosaic(width, height, bayer, seed);
    Mask(&whole, seed);
    const PixelRect rect = RandomRect(width, height, seed);
    const LfPixels mosaic = PartOf(whole, MosaicRectOf(rect, width, height));
    Balance white_balance = {2, 1, 1.5};
    for (double& factor : white_balance)
      if (seed % 5 != 0) factor = 0.1 + 4 * RandomUnit(seed, 9, static_cast<uint64_t>(factor * 2));
    const RadianceEncoding encoding =
        EncodingOf(white_balance, seed % 3 * 5000., seed % 4 == 0 ? 16 : 1);
    Demosaic(mosaic, width, height, encoding, rect, &rgb);
    DemosaicReference(mosaic, width, height, encoding, rect, &reference);
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

// A wide image is cut into strips.
TEST(Demosaic, StripsOfWideImagesFit) {
  const LfPixels mosaic = NoiseMosaic(2100, 5, BayerPattern::kGbrg, 6);
  const RadianceEncoding encoding = EncodingOf({2, 1, 1.5});
  LfPixels rgb, reference;
  for (const PixelRect& rect : {PixelRect{0, 0, 2100, 5}, PixelRect{3, 1, 2098, 4}}) {
    Demosaic(mosaic, 2100, 5, encoding, rect, &rgb);
    DemosaicReference(mosaic, 2100, 5, encoding, rect, &reference);
    ExpectSame(rgb, reference);
  }
}

TEST(Demosaic, TheCutIntoRectanglesDoesNotMatter) {
  constexpr int kMosaicWidth = 43, kMosaicHeight = 34;
  const RadianceEncoding encoding = EncodingOf({2.3, 1, 1.4});
  for (const BayerPattern bayer : kPatterns) {
    LfPixels mosaic = NoiseMosaic(kMosaicWidth, kMosaicHeight, bayer, 1);
    for (int x = 9; x < 16; ++x) mosaic.Mask(x, 6 + x % 4);
    const LfPixels whole = RgbOf(mosaic, encoding);
    for (uint64_t seed = 0; seed < 50; ++seed) {
      const PixelRect rect = RandomRect(kMosaicWidth, kMosaicHeight, seed);
      LfPixels rgb;
      Demosaic(PartOf(mosaic, MosaicRectOf(rect, kMosaicWidth, kMosaicHeight)), kMosaicWidth,
               kMosaicHeight, encoding, rect, &rgb);
      for (int y = rect.y_begin; y < rect.y_end; ++y)
        for (int x = rect.x_begin; x < rect.x_end; ++x)
          for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
            ASSERT_EQ(rgb.radiance.at(x - rect.x_begin, y - rect.y_begin, lane),
                      whole.radiance.at(x, y, lane));
    }
  }
}

TEST(Demosaic, NeedsThirteenPixelsMoreWithinTheImage) {
  EXPECT_EQ(MosaicRectOf({15, 16, 18, 19}, 50, 50), (PixelRect{2, 3, 31, 32}));
  EXPECT_EQ(MosaicRectOf({12, 0, 38, 50}, 50, 50), (PixelRect{0, 0, 50, 50}));
  EXPECT_TRUE(MosaicRectOf({}, 20, 20).empty());
  LfPixels rgb({0, 0, 3, 3}, BayerPattern::kNone);
  Demosaic(LfPixels({}, BayerPattern::kRggb), 20, 20, RadianceEncoding(), {}, &rgb);
  EXPECT_TRUE(rgb.radiance.empty());
}

TEST(Demosaic, RecordedColoursAreKept) {
  for (const BayerPattern bayer : kPatterns) {
    const LfPixels mosaic = NoiseMosaic(31, 20, bayer, 3);
    const LfPixels rgb = RgbOf(mosaic, EncodingOf({2, 1, 1.5}));
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 31; ++x) {
        ASSERT_EQ(rgb.radiance.at(x, y, BayerChannel(bayer, x, y)), mosaic.radiance.at(x, y));
        ASSERT_EQ(rgb.radiance.at(x, y, LfPixels::kRayLane), 1);
      }
  }
}

// Every colour has a value of its own; some are below a pedestal.
TEST(Demosaic, ConstantColoursAreExact) {
  const auto values = {std::array{0, 0, 0},
                       {4096, 4096, 4096},
                       {65535, 65535, 65535},
                       std::array{20000, 700, 65535},
                       {5000, 30000, 9000}};
  for (const BayerPattern bayer : kPatterns)
    for (const Balance& white_balance : {kBalanced, Balance{2.1, 1, 1.7}, Balance{1, 30, 0.01}})
      for (const double pedestal : {0., kPedestal})
        for (const std::array<int, 3>& value : values) {
          const auto colour = [&](int, int, int channel) {
            return value[static_cast<size_t>(channel)];
          };
          const LfPixels rgb =
              RgbOf(MosaicOf(7, 6, bayer, colour), EncodingOf(white_balance, pedestal));
          for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 7; ++x)
              for (int channel = 0; channel < 3; ++channel)
                ASSERT_EQ(rgb.radiance.at(x, y, channel), colour(x, y, channel));
        }
}

// The square root bends ramps, which costs at most one step in 65535 here.
TEST(Demosaic, GreyRampsAreExactAwayFromBorders) {
  constexpr int kSize = 40;
  const Balance white_balance = {1.6, 1, 1.28};
  for (const BayerPattern bayer : kPatterns) {
    const auto ramp = [&](int x, int y, int channel) {
      return kPedestal + (6000 + 40 * x + 25 * y) / white_balance[static_cast<size_t>(channel)];
    };
    const LfPixels rgb = RgbOf(MosaicOf(kSize, kSize, bayer, ramp), EncodingOf(white_balance));
    for (int y = 13; y < kSize - 13; ++y)
      for (int x = 13; x < kSize - 13; ++x)
        for (int channel = 0; channel < 3; ++channel)
          ASSERT_NEAR(rgb.radiance.at(x, y, channel), ramp(x, y, channel), 2);
  }
}

// Noise that is evenly distributed would overshoot often.
TEST(Demosaic, GreenLiesWithinItsNeighbours) {
  for (const BayerPattern bayer : kPatterns) {
    const LfPixels mosaic = NoiseMosaic(40, 30, bayer, 9);
    const LfPixels rgb = RgbOf(mosaic, EncodingOf({2, 1, 1.5}));
    for (int y = 1; y < 29; ++y)
      for (int x = 1; x < 39; ++x) {
        if (BayerChannel(bayer, x, y) == 1) continue;
        const auto& at = mosaic.radiance;
        const auto [least, most] =
            std::minmax({at.at(x - 1, y), at.at(x + 1, y), at.at(x, y - 1), at.at(x, y + 1)});
        ASSERT_GE(rgb.radiance.at(x, y, 1), least);
        ASSERT_LE(rgb.radiance.at(x, y, 1), most);
      }
  }
}

// A lamp that is clipped in all colours has the colour of the white balance. Its grey surroundings
// stay grey from 3 pixels away on, although details of it are seen up to 11 pixels away.
TEST(Demosaic, ClippedLampsHaveNoFringes) {
  constexpr double kDark = 2000, kWhite = 65535;
  const Balance white_balance = {2, 1, 1.5};
  for (const BayerPattern bayer : kPatterns)
    for (const double radius : {1., 2.3, 5.}) {
      const LfPixels mosaic = MosaicOf(60, 60, bayer, [&](int x, int y, int channel) {
        const double away = std::hypot(x - 30.3, y - 29.6);
        return away < radius ? kWhite : kDark / white_balance[static_cast<size_t>(channel)];
      });
      const LfPixels rgb = RgbOf(mosaic, EncodingOf(white_balance, 0));
      for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 60; ++x)
          for (int channel = 0; channel < 3; ++channel)
            if (std::hypot(x - 30.3, y - 29.6) > radius + 3) {
              const double dark = kDark / white_balance[static_cast<size_t>(channel)];
              ASSERT_NEAR(rgb.radiance.at(x, y, channel), dark, 0.01 * kWhite) << x << " " << y;
            }
    }
}

// A vertical edge: green is interpolated along it, not across it.
TEST(Demosaic, EdgesStaySharp) {
  for (const BayerPattern bayer : kPatterns) {
    const auto edge = [](int x, int /*y*/, int /*channel*/) { return x < 20 ? 8000 : 40000; };
    const LfPixels rgb = RgbOf(MosaicOf(41, 40, bayer, edge), EncodingOf(kBalanced));
    for (int x = 13; x < 28; ++x)
      for (int channel = 0; channel < 3; ++channel)
        ASSERT_NEAR(rgb.radiance.at(x, 20, channel), edge(x, 20, channel), 1500) << x;
  }
}

// The light of a test picture: rings that get finer, with colours that change slowly and faster.
double LightAt(double x, double y, int channel) {
  const double r2 = (x - 40) * (x - 40) + (y - 32) * (y - 32);
  const double rings = std::cos(r2 / 60), colour = std::sin(0.09 * x + 0.05 * y + 2 * channel);
  const double spot = std::exp(-((x - 20) * (x - 20) + (y - 48) * (y - 48)) / 3);
  return 0.25 + 0.12 * rings + 0.08 * colour + 0.05 * colour * rings + 0.3 * spot;
}

// Returns the mean of the pixels of a colour in a 5 x 5 neighbourhood, weighted by `weights`, plus
// those of the pixel's own colour by `laplacian`; both in units of 1/16.
struct LinearFilter {
  int mean[5][5], laplacian[5][5];
};
constexpr LinearFilter kGreenFilter = {{{0}, {0, 0, 4}, {0, 4, 0, 4}, {0, 0, 4}, {0}},
                                       {{0, 0, -2}, {0}, {-2, 0, 8, 0, -2}, {0}, {0, 0, -2}}};
constexpr LinearFilter kBesideFilter = {
    {{0}, {0}, {0, 8, 0, 8}, {0}, {0}},
    {{0, 0, 1}, {0, -2, 0, -2}, {-2, 0, 10, 0, -2}, {0, -2, 0, -2}, {0, 0, 1}}};
constexpr LinearFilter kAboveFilter = {
    {{0}, {0, 0, 8}, {0}, {0, 0, 8}, {0}},
    {{0, 0, -2}, {0, -2, 0, -2}, {1, 0, 10, 0, 1}, {0, -2, 0, -2}, {0, 0, -2}}};
constexpr LinearFilter kOppositeFilter = {{{0}, {0, 4, 0, 4}, {0}, {0, 4, 0, 4}, {0}},
                                          {{0, 0, -3}, {0}, {-3, 0, 12, 0, -3}, {0}, {0, 0, -3}}};

// Demosaics linearly: bilinear, or with Laplacians as Malvar, He and Cutler 2004 do.
double LinearColour(const LfPixels& mosaic, int x, int y, int channel, bool with_laplacian) {
  const int recorded = BayerChannel(mosaic.bayer, x, y);
  if (recorded == channel) return mosaic.radiance.at(x, y);
  const LinearFilter& filter = channel == 1                                      ? kGreenFilter
                               : recorded != 1                                   ? kOppositeFilter
                               : BayerChannel(mosaic.bayer, x + 1, y) == channel ? kBesideFilter
                                                                                 : kAboveFilter;
  double sum = 0;
  for (int dy = 0; dy < 5; ++dy)
    for (int dx = 0; dx < 5; ++dx)
      sum += (filter.mean[dy][dx] + (with_laplacian ? filter.laplacian[dy][dx] : 0)) *
             mosaic.radiance.at(x + dx - 2, y + dy - 2) / 16.;
  return sum;
}

// The picture is grey enough for the white balance to be 1, so that the linear methods need none.
TEST(Demosaic, IsBetterThanLinearMethods) {
  constexpr int kWidth = 80, kHeight = 64, kBorder = 13;
  const auto level = [](int x, int y, int channel) {
    return kPedestal + (65535 - kPedestal) * LightAt(x, y, channel);
  };
  for (const BayerPattern bayer : kPatterns) {
    const LfPixels mosaic = MosaicOf(kWidth, kHeight, bayer, level);
    const LfPixels rgb = RgbOf(mosaic, EncodingOf(kBalanced));
    double errors[3] = {};
    for (int y = kBorder; y < kHeight - kBorder; ++y)
      for (int x = kBorder; x < kWidth - kBorder; ++x)
        for (int channel = 0; channel < 3; ++channel) {
          const double truth = level(x, y, channel);
          errors[0] += std::pow(rgb.radiance.at(x, y, channel) - truth, 2);
          errors[1] += std::pow(LinearColour(mosaic, x, y, channel, true) - truth, 2);
          errors[2] += std::pow(LinearColour(mosaic, x, y, channel, false) - truth, 2);
        }
    const auto gain_db = [&](int i) { return 10 * std::log10(errors[i] / errors[0]); };
    EXPECT_GT(gain_db(1), 2) << "against Malvar, He and Cutler";
    EXPECT_GT(gain_db(2), 4.5) << "against bilinear interpolation";
  }
}

// Except for rounding and for the offset of the roots, it makes no difference whether the pixels
// are white balanced before or after demosaicing, because Demosaic() takes it into account.
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
    const LfPixels before =
        RgbOf(MosaicOf(kSize, kSize, bayer, balanced), EncodingOf(kBalanced, 0));
    const LfPixels after = RgbOf(MosaicOf(kSize, kSize, bayer, recorded), EncodingOf({4, 1, 2}, 0));
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int channel = 0; channel < 3; ++channel) {
          const int factor = factors[static_cast<size_t>(channel)];
          ASSERT_NEAR(after.radiance.at(x, y, channel) * factor, before.radiance.at(x, y, channel),
                      factor / 2 + 1);
        }
  }
}

// A scale changes nothing but the steps of the result.
TEST(Demosaic, ScaleAndPedestalDoNotChangeTheLight) {
  constexpr int kSize = 30;
  const LfPixels plain = SmoothMosaic(kSize, kSize, BayerPattern::kGrbg, 5);
  const RadianceEncoding encoding = EncodingOf({2, 1, 1.5}, 0);
  RadianceEncoding roomy = EncodingOf({2, 1, 1.5}, 16384);
  roomy.overshoot_room = 2;
  const double scale = roomy.Scale() / encoding.Scale();
  const LfPixels shifted = MosaicOf(kSize, kSize, BayerPattern::kGrbg, [&](int x, int y, int) {
    return roomy.pedestal + scale * plain.radiance.at(x, y) + 0.5;
  });
  const LfPixels a = RgbOf(plain, encoding), b = RgbOf(shifted, roomy);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (int channel = 0; channel < 3; ++channel)
        ASSERT_NEAR(b.radiance.at(x, y, channel),
                    roomy.pedestal + scale * a.radiance.at(x, y, channel), 2);
}

// Compares an image with a larger one that contains it and its mirrored surroundings, in which the
// inner pixels are away from the border.
TEST(Demosaic, BordersAreMirroredAboutTheOutermostPixels) {
  constexpr int kAround = 14;
  for (const BayerPattern bayer : kPatterns)
    for (const auto& size : {std::pair(2, 2), std::pair(3, 2), std::pair(8, 5)}) {
      const int width = size.first, height = size.second;
      const LfPixels small = NoiseMosaic(width, height, bayer, 2);
      const auto inside = [](int position, int side) {
        const int period = 2 * (side - 1), phase = (position + 14 * period) % period;
        return phase < side ? phase : period - phase;
      };
      const LfPixels large = MosaicOf(
          width + 2 * kAround, height + 2 * kAround, bayer, [&](int x, int y, int /*channel*/) {
            return small.radiance.at(inside(x - kAround, width), inside(y - kAround, height));
          });
      const RadianceEncoding encoding = EncodingOf({1.5, 1, 2});
      const LfPixels rgb = RgbOf(small, encoding), rgb_large = RgbOf(large, encoding);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
            ASSERT_EQ(rgb.radiance.at(x, y, lane),
                      rgb_large.radiance.at(x + kAround, y + kAround, lane));
    }
}

TEST(Demosaic, AMaskedPixelMasksWhatIsMadeFromIt) {
  const RadianceEncoding encoding = EncodingOf(kBalanced);
  LfPixels mosaic = NoiseMosaic(9, 9, BayerPattern::kGrbg, 4);
  EXPECT_FALSE(RgbOf(mosaic, encoding).any_masked);
  mosaic.Mask(4, 3);
  const LfPixels rgb = RgbOf(mosaic, encoding);
  EXPECT_TRUE(rgb.any_masked);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x)
      EXPECT_EQ(rgb.IsMasked(x, y), std::abs(x - 4) + std::abs(y - 3) <= 2) << x << ", " << y;
  // The masked pixel is in a corner of the loaded part, too far away to mask a pixel of the result.
  LfPixels large = NoiseMosaic(40, 40, BayerPattern::kGrbg, 4), part;
  large.Mask(7, 7);
  Demosaic(PartOf(large, {7, 7, 40, 40}), 40, 40, encoding, {20, 20, 27, 27}, &part);
  EXPECT_FALSE(part.any_masked);
}

// The value under a mask is unknown, so it must not matter.
TEST(Demosaic, ValuesOfMaskedPixelsDoNotMatter) {
  const RadianceEncoding encoding = EncodingOf({2, 1, 1.5});
  for (const BayerPattern bayer : kPatterns)
    for (const auto& [x, y] : {std::pair(20, 20), {21, 20}, {20, 21}, {21, 21}, {0, 1}, {40, 39}}) {
      LfPixels mosaic = SmoothMosaic(41, 40, bayer, 8);
      mosaic.Mask(x, y);
      const LfPixels rgb = RgbOf(mosaic, encoding);
      mosaic.radiance.at(x, y) = 65535;
      ExpectSame(rgb, RgbOf(mosaic, encoding));
    }
}

// A masked pixel is replaced by the mean of those of its colour around it: here by the constant.
TEST(Demosaic, MaskedPixelsAreReplacedByTheMeanAroundThem) {
  const RadianceEncoding encoding = EncodingOf({2, 1, 1.5});
  const auto constant = [](int, int, int channel) { return 9000 + 3000 * channel; };
  LfPixels mosaic = MosaicOf(30, 30, BayerPattern::kBggr, constant);
  for (const auto& [x, y] : {std::pair(12, 12), {14, 12}, {15, 15}, {0, 0}, {29, 28}}) {
    mosaic.Mask(x, y);
    mosaic.radiance.at(x, y) = 0;
  }
  const LfPixels rgb = RgbOf(mosaic, encoding);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x)
      for (int channel = 0; channel < 3; ++channel) {
        const int expected = rgb.IsMasked(x, y) ? 0 : constant(x, y, channel);
        ASSERT_EQ(rgb.radiance.at(x, y, channel), expected) << x << ", " << y;
      }
}

}  // namespace
}  // namespace lf
