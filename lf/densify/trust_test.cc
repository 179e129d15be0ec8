// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/trust.h"

#include <gtest/gtest.h>

#include <vector>

namespace lf {
namespace {

constexpr float kFloor = 0.02f * 3 * 65535;

WeighedColour Colour(float r, float g, float b, float weight) {
  return {PixelLanes{r, g, b, 0}, weight};
}

TEST(Trust, IsTheVotesIfColoursAgree) {
  EXPECT_EQ(TrustOf(1, 0), 255);
  EXPECT_EQ(TrustOf(1.2f, 0), 255);
  EXPECT_EQ(TrustOf(0.4f, 0), 102);
  EXPECT_EQ(TrustOf(0, 0), 0);
  EXPECT_EQ(TrustOf(-0.5f, 0), 0);
}

TEST(Trust, FallsAsColoursSpread) {
  EXPECT_EQ(TrustOf(1, kVisibleSpread / 4), 191);
  EXPECT_EQ(TrustOf(1, kVisibleSpread / 2), 128);
  EXPECT_EQ(TrustOf(0.5f, kVisibleSpread / 2), 64);
  EXPECT_EQ(TrustOf(1, kVisibleSpread), 0);
  EXPECT_EQ(TrustOf(1, 9), 0);
}

TEST(Trust, TheSpreadIsTheMeanDistanceFromTheMean) {
  // The mean is 9000, 3000, 3000; the distances are 3000 and 1000, 0, 0.
  const std::vector<WeighedColour> colours = {Colour(6000, 3000, 3000, 1),
                                              Colour(10000, 3000, 3000, 3)};
  EXPECT_NEAR(SpreadOf(colours), (0.25 * 3000 + 0.75 * 1000) / (15000 + kFloor), 1e-6);
  // The scale of weights does not matter, and colours without weight do not count.
  const std::vector<WeighedColour> scaled = {
      Colour(6000, 3000, 3000, 0.1f), Colour(10000, 3000, 3000, 0.3f), Colour(0, 60000, 0, 0)};
  EXPECT_NEAR(SpreadOf(scaled), SpreadOf(colours), 1e-6);
}

TEST(Trust, EqualColoursAndNoColoursDoNotSpread) {
  const std::vector<WeighedColour> equal(5, Colour(100, 200, 60000, 0.2f));
  EXPECT_NEAR(SpreadOf(equal), 0, 1e-6);
  EXPECT_EQ(SpreadOf({}), 0);
  const std::vector<WeighedColour> without = {Colour(100, 200, 300, 0), Colour(900, 200, 300, 0)};
  EXPECT_EQ(SpreadOf(without), 0);
}

TEST(Trust, NoiseOfDarkPixelsHardlySpreads) {
  const std::vector<WeighedColour> dark = {Colour(0, 0, 0, 1), Colour(100, 100, 100, 1)};
  EXPECT_LT(SpreadOf(dark), 0.05f);
  const std::vector<WeighedColour> bright = {Colour(0, 0, 0, 1), Colour(40000, 40000, 40000, 1)};
  EXPECT_GT(SpreadOf(bright), 0.9f);
}

}  // namespace
}  // namespace lf
