// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/prefilter/mosaic_correction.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "lf/collection/prefilter/prefilter.h"
#include "lf/core/random.h"

namespace lf {
namespace {

constexpr BayerPattern kPatterns[] = {BayerPattern::kRggb, BayerPattern::kBggr, BayerPattern::kGrbg,
                                      BayerPattern::kGbrg};

// Random pixels, of which every third value is the largest one.
LfPixels RandomPixels(const PixelRect& rect, BayerPattern recorded, uint64_t seed,
                      double masked_share) {
  LfPixels pixels(rect, BayerPattern::kNone);
  pixels.recorded = recorded;
  for (int y = 0; y < rect.height(); ++y)
    for (int x = 0; x < rect.width(); ++x) {
      const auto n = static_cast<uint64_t>(x + 1000 * y);
      for (uint64_t c = 0; c < 3; ++c)
        pixels.radiance.at(x, y, static_cast<int>(c)) =
            RandomBits(seed, n, c) % 3 == 0 ? 65535
                                            : static_cast<uint16_t>(RandomBits(seed, n, 7 + c));
      if (RandomUnit(seed, n, 11) < masked_share) pixels.Mask(x, y);
    }
  return pixels;
}

Prefilter Only(int correction) {
  Prefilter filter;
  filter.correction = correction;
  return filter;
}

void ExpectReference(const std::string& target) {
  uint64_t seed = 0;
  for (const double masked : {0., 0.01, 0.3})
    for (const PixelRect rect : {PixelRect{3, 4, 40, 25}, PixelRect{0, 1, 1, 2},
                                 PixelRect{0, 0, 2, 30}, PixelRect{5, 5, 71, 9}})
      for (const BayerPattern pattern : kPatterns) {
        const int strength = 1 + static_cast<int>(++seed % kStrongestCorrection);
        const LfPixels pixels = RandomPixels(rect, pattern, seed, masked);
        MosaicCorrector corrector(strength, pixels);
        for (int y = 0; y < rect.height(); ++y) {
          const uint16_t* const row = corrector.Row(y);
          for (int x = 0; x < rect.width(); ++x) {
            for (int c = 0; c < 3; ++c)
              ASSERT_EQ(row[x * LfPixels::kRgbLanes + c],
                        pixels.IsMasked(x, y) ? 0 : CorrectedReference(strength, pixels, x, y, c))
                  << target << " " << x << " " << y << " " << masked;
            ASSERT_EQ(row[x * LfPixels::kRgbLanes + LfPixels::kRayLane], !pixels.IsMasked(x, y));
          }
        }
        // The steps of FilterPixels() that follow get the corrected values.
        for (Prefilter filter : {Only(0), PrefilterFor(1, PixelFootprint::kArea),
                                 PrefilterFor(4, PixelFootprint::kPoint)}) {
          filter.correction = strength;
          LfPixels literal, fast, in_place = pixels, in_parts = pixels;
          FilterPixelsReference(filter, pixels, &literal);
          FilterPixels(filter, pixels, &fast);
          FilterInPlace(filter, &in_place);
          ASSERT_EQ(fast.radiance.pixels(), literal.radiance.pixels()) << target;
          ASSERT_EQ(in_place.radiance.pixels(), literal.radiance.pixels()) << target;
          // The rows of this copy become complete in groups of one to four.
          std::fill(in_parts.radiance.pixels().begin(), in_parts.radiance.pixels().end(), 7);
          InPlaceFilter in_parts_filter(filter, &in_parts);
          const int row_values = rect.width() * LfPixels::kRgbLanes;
          for (int y = 0; y < rect.height();) {
            const int end = std::min(rect.height(), y + 1 + (y + static_cast<int>(seed)) % 4);
            std::copy(pixels.radiance.row(0) + y * row_values,
                      pixels.radiance.row(0) + end * row_values, in_parts.radiance.row(y));
            in_parts_filter.Advance(y = end);
          }
          ASSERT_EQ(in_parts.radiance.pixels(), literal.radiance.pixels()) << target;
        }
      }
}

TEST(MosaicCorrection, HasTheBitsOfTheReferenceWithAllInstructions) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    ExpectReference(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

// Sums of products must fit into 32 bits.
TEST(MosaicCorrection, SumsFit) {
  for (int strength = 1; strength <= kStrongestCorrection; ++strength)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x)
        for (int c = 0; c < 3; ++c) {
          const auto weights = CorrectionWeights(strength, BayerPattern::kRggb, x, y, c);
          int sum = 0;
          for (size_t k = 0; k < weights.size(); ++k)
            sum +=
                (MosaicCorrection::kGroups[k][0] > 0 && MosaicCorrection::kGroups[k][1] > 0 ? 4
                                                                                            : 2) *
                std::abs(weights[k]);
          EXPECT_LT(sum, 1 << 14);
        }
}

TEST(MosaicCorrection, KeepsConstantsAndRamps) {
  for (const BayerPattern pattern : kPatterns)
    for (int strength = 1; strength <= kStrongestCorrection; ++strength) {
      LfPixels ramp({1, 2, 41, 42}, BayerPattern::kNone);
      ramp.recorded = pattern;
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
          for (int c = 0; c < 3; ++c)
            ramp.radiance.at(x, y, c) = static_cast<uint16_t>(20000 + c * (300 * x - 100 * y));
      MosaicCorrector corrector(strength, ramp);
      for (int y = 0; y < 40; ++y) {
        const uint16_t* const row = corrector.Row(y);
        for (int x = 2; x < 38 && y >= 2 && y < 38; ++x)
          for (int c = 0; c < 3; ++c)
            ASSERT_EQ(row[x * LfPixels::kRgbLanes + c], ramp.radiance.at(x, y, c));
      }
    }
}

// All patterns show a colour in the same surroundings, moved.
TEST(MosaicCorrection, WeightsMoveWithThePattern) {
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y)
      for (int strength = 1; strength <= kStrongestCorrection; ++strength) {
        EXPECT_EQ(CorrectionWeights(strength, BayerPattern::kRggb, x, y, 0),
                  CorrectionWeights(strength, BayerPattern::kGrbg, x + 1, y, 0));
        EXPECT_EQ(CorrectionWeights(strength, BayerPattern::kRggb, x, y, 1),
                  CorrectionWeights(strength, BayerPattern::kBggr, x, y, 1));
        EXPECT_EQ(CorrectionWeights(strength, BayerPattern::kRggb, x, y, 2),
                  CorrectionWeights(strength, BayerPattern::kGbrg, x, y + 1, 2));
      }
}

// Green pixels beside red ones take red mostly from these, whether they stand in a row or a column.
TEST(MosaicCorrection, ColoursComeFromWhereTheyWereRecorded) {
  for (int strength = 1; strength <= kStrongestCorrection; ++strength) {
    const auto in_row = CorrectionWeights(strength, BayerPattern::kRggb, 1, 0, 0);
    const auto in_column = CorrectionWeights(strength, BayerPattern::kRggb, 0, 1, 0);
    ASSERT_EQ(MosaicCorrection::kGroups[0][0], 1);  // group 0 is beside, group 2 above and below
    ASSERT_EQ(MosaicCorrection::kGroups[2][1], 1);
    EXPECT_GT(in_row[0], in_row[2] + 500) << strength;
    EXPECT_EQ(in_column[0], in_row[2]);
    EXPECT_EQ(in_column[2], in_row[0]);
  }
}

// A dot that interpolation has lost where it was not recorded: it becomes brighter in the mean of
// the four places of the pattern, the more the stronger the correction is.
TEST(MosaicCorrection, RestoresWhatTheMeanHasLost) {
  double before = 0;
  for (int strength = 0; strength <= kStrongestCorrection; ++strength) {
    double mean = 0;
    for (const BayerPattern pattern : kPatterns) {
      LfPixels pixels({0, 0, 9, 9}, BayerPattern::kNone), corrected;
      pixels.recorded = pattern;
      for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x)
          for (int c = 0; c < 3; ++c) pixels.radiance.at(x, y, c) = 10000;
      if (BayerChannel(pattern, 4, 4) == 0) pixels.radiance.at(4, 4, 0) = 30000;
      FilterPixels(Only(strength), pixels, &corrected);
      mean += corrected.radiance.at(4, 4, 0) / 4.;
    }
    if (strength > 0) {
      EXPECT_GT(mean, before + 400) << strength;
    }
    before = mean;
  }
  EXPECT_GT(before, 17000);
}

}  // namespace
}  // namespace lf
