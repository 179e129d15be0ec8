// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/radiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace lf {
namespace {

TEST(Radiance, SrgbHasItsPublishedValues) {
  EXPECT_EQ(LinearFromSrgb(0), 0);
  EXPECT_DOUBLE_EQ(LinearFromSrgb(1), 1);
  EXPECT_NEAR(LinearFromSrgb(0.5), 0.214041140482232, 1e-15);
  EXPECT_NEAR(LinearFromSrgb(0.04045), 0.0031308, 1e-7);
  EXPECT_NEAR(SrgbFromLinear(0.18), 0.461356129500442, 1e-15);
}

TEST(Radiance, SrgbAndItsInverseUndoEachOther) {
  for (int i = 0; i <= 1000; ++i) {
    const double x = i / 1000.0;
    EXPECT_NEAR(SrgbFromLinear(LinearFromSrgb(x)), x, 1e-7) << x;  // the two pieces of the
                                                                   // standard's curve do not meet
                                                                   // exactly
  }
}

TEST(RadianceTable, EightBitSrgbRunsFromNoLightToFullScale) {
  const std::vector<uint16_t> table = RadianceTable({}, 8, 1);
  ASSERT_EQ(table.size(), 256u);
  EXPECT_EQ(table[0], 0);
  EXPECT_EQ(table[1], 20);       // 1 / 255 / 12.92 * 65535 = 19.89
  EXPECT_EQ(table[128], 14146);  // 0.2158605 * 65535 = 14146.4
  EXPECT_EQ(table[255], 65535);
  for (size_t i = 1; i < 256; ++i) EXPECT_GT(table[i], table[i - 1]) << i;
}

TEST(RadianceTable, SixteenBitLinearIsTheIdentity) {
  RadianceEncoding encoding;
  encoding.transfer = Transfer::kLinear;
  const std::vector<uint16_t> table = RadianceTable(encoding, 16, 1);
  ASSERT_EQ(table.size(), 65536u);
  for (size_t i = 0; i < table.size(); ++i) ASSERT_EQ(table[i], i);
}

RadianceEncoding Raw12Bit() {
  RadianceEncoding encoding;
  encoding.bayer = BayerPattern::kRggb;
  encoding.transfer = Transfer::kLinear;
  encoding.black_level = 256;
  encoding.white_level = 4095;
  encoding.pedestal = 1024;
  return encoding;
}

TEST(RadianceTable, BlackLevelBecomesThePedestalAndWhiteLevelFullScale) {
  const std::vector<uint16_t> table = RadianceTable(Raw12Bit(), 16, 1);
  EXPECT_EQ(table[256], 1024);
  EXPECT_EQ(table[4095], 65535);
  EXPECT_EQ(table[4096], 65535);
  EXPECT_EQ(table[65535], 65535);
}

TEST(RadianceTable, NoiseAroundBlackAveragesToBlack) {
  const std::vector<uint16_t> table = RadianceTable(Raw12Bit(), 16, 1);
  for (size_t noise = 0; noise <= 60; ++noise)
    EXPECT_EQ(table[256 - noise] + table[256 + noise], 2 * 1024) << noise;
  EXPECT_EQ(table[0], 0);  // clipped: 256 steps of 16.8 are more than the pedestal of 1024
}

TEST(RadianceTable, HalvesRoundAwayFromZero) {
  RadianceEncoding encoding;
  encoding.transfer = Transfer::kLinear;
  encoding.black_level = 3;
  encoding.white_level = 5;
  encoding.pedestal = 65535 - 5;  // 2.5 steps of v per stored value
  const std::vector<uint16_t> table = RadianceTable(encoding, 8, 1);
  EXPECT_EQ(table[4], 65530 + 3);
  EXPECT_EQ(table[2], 65530 - 3);
  EXPECT_EQ(table[1], 65530 - 5);
}

TEST(RadianceTable, GainMultipliesLightNotThePedestal) {
  const RadianceEncoding encoding = Raw12Bit();
  const std::vector<uint16_t> table = RadianceTable(encoding, 16, 0.5);
  EXPECT_EQ(table[256], 1024);
  EXPECT_EQ(table[4095], 1024 + std::lround((65535 - 1024) * 0.5));
  EXPECT_EQ(RadianceTable(encoding, 16, 2)[4095], 65535);  // clipped
}

TEST(RadianceTable, MaxRadianceIsWhereTheScaleEnds) {
  RadianceEncoding encoding;
  encoding.max_radiance = 4;
  EXPECT_EQ(RadianceTable(encoding, 8, 1)[255], std::lround(65535 / 4.0));
  EXPECT_EQ(RadianceTable(encoding, 8, 4)[255], 65535);
}

TEST(RadianceTable, AResponseCurveIsInterpolatedBetweenItsEntries) {
  RadianceEncoding encoding;
  encoding.transfer = Transfer::kResponse;
  encoding.response = {0, 0.1, 1};  // the radiance at 50, 100 and 150
  encoding.black_level = 50;
  encoding.white_level = 150;
  encoding.pedestal = 1000;
  const auto v = [&](double radiance) { return 1000 + std::lround(radiance * (65535 - 1000)); };
  const std::vector<uint16_t> table = RadianceTable(encoding, 8, 1);
  EXPECT_EQ(table[50], v(0));
  EXPECT_EQ(table[75], v(0.05));
  EXPECT_EQ(table[100], v(0.1));
  EXPECT_EQ(table[125], v(0.55));
  EXPECT_EQ(table[150], v(1));
  EXPECT_EQ(table[255], v(1));     // saturated
  EXPECT_EQ(table[45], v(-0.01));  // noise below black, on the first slope
}

TEST(QuantizeRadiance, TakesAnyFloat) {
  RadianceEncoding encoding;
  encoding.max_radiance = 16;
  encoding.pedestal = 7;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(QuantizeRadiance(encoding, std::nan(""), 1), 7);
  EXPECT_EQ(QuantizeRadiance(encoding, kInfinity, 1), 65535);
  EXPECT_EQ(QuantizeRadiance(encoding, -kInfinity, 1), 0);
  EXPECT_EQ(QuantizeRadiance(encoding, 1e300, 1e6), 65535);
  EXPECT_EQ(QuantizeRadiance(encoding, -1, 1), 0);
  EXPECT_EQ(QuantizeRadiance(encoding, 0, 1), 7);
  EXPECT_EQ(QuantizeRadiance(encoding, 16, 1), 65535);
  EXPECT_EQ(QuantizeRadiance(encoding, 1, 1), 7 + std::lround((65535 - 7) / 16.0));
}

TEST(Levels, FitOnlyWhereTheFilesCanHoldThem) {
  RadianceEncoding encoding = Raw12Bit();
  EXPECT_TRUE(LevelsFit(encoding, 16));
  EXPECT_FALSE(LevelsFit(encoding, 8));  // white at 4095
  encoding.white_level.reset();
  EXPECT_FALSE(LevelsFit(encoding, 8));  // black at 256, white at 255
  encoding.black_level = 16;
  EXPECT_TRUE(LevelsFit(encoding, 8));
}

TEST(Levels, ClipNearWhiteCountedFromBlack) {
  RadianceEncoding encoding = Raw12Bit();  // levels 256 to 4095
  EXPECT_DOUBLE_EQ(ClippedFrom(encoding, 16), 256 + 0.99 * 3839);
  encoding.white_level.reset();
  EXPECT_DOUBLE_EQ(ClippedFrom(encoding, 16), 256 + 0.99 * (65535 - 256));
  encoding.black_level = 0;
  EXPECT_DOUBLE_EQ(ClippedFrom(encoding, 8), 0.99 * 255);
}

TEST(DefaultMaxRadiance, LeavesRoomForHighlightsInFloatFiles) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(DefaultMaxRadiance(Names{"a.png", "b.jpg"}), 1);
  EXPECT_EQ(DefaultMaxRadiance(Names{"a.exr"}), 16);
  EXPECT_EQ(DefaultMaxRadiance(Names{"a.png", "b.HDR"}), 16);
  EXPECT_EQ(DefaultMaxRadiance(Names{}), 1);
}

TEST(RadianceTable, RoomForUndershootIsNeverLess) {
  RadianceEncoding encoding;
  encoding.max_radiance = 4;
  MakeRoomForUndershoot(&encoding);
  EXPECT_EQ(encoding.pedestal, kUndershootPedestal);
  EXPECT_EQ(QuantizeRadiance(encoding, 0, 1), kUndershootPedestal);
  EXPECT_EQ(QuantizeRadiance(encoding, 4, 1), 65535);
  EXPECT_GT(QuantizeRadiance(encoding, -4.0 / 15.1, 1), 0);
  encoding.pedestal = 9000;
  MakeRoomForUndershoot(&encoding);
  EXPECT_EQ(encoding.pedestal, 9000);
}

TEST(RadianceTable, HasRoomBelowBlackAndAboveWhite) {
  const std::vector<std::string> integers = {"a.png"}, floats = {"a.exr"};
  RadianceEncoding encoding;
  MakeRoomBesideEdges(integers, &encoding);
  EXPECT_EQ(QuantizeRadiance(encoding, 0, 1), kRoomPedestal);
  EXPECT_EQ(65535 - kRoomPedestal, 2 * encoding.Scale());
  EXPECT_GT(QuantizeRadiance(encoding, -0.66, 1), 0);
  encoding.pedestal = 20000;
  encoding.max_radiance = 16;
  MakeRoomBesideEdges(floats, &encoding);
  EXPECT_EQ(encoding.pedestal, 20000);
  EXPECT_EQ(encoding.max_radiance, 16);
  encoding.max_radiance = 1;
  MakeRoomBesideEdges(floats, &encoding);
  EXPECT_EQ(encoding.overshoot_room, 2);
}

TEST(Radiance, RoomForOvershootKeepsNoBrighterLight) {
  const std::vector<std::string> integers = {"a.png"};
  for (const double most : {1.0, 3.0, 5.46}) {
    RadianceEncoding encoding;
    encoding.max_radiance = most;
    const auto kept = [&](double radiance) {
      return (QuantizeRadiance(encoding, radiance, 1) - encoding.pedestal) / encoding.Scale();
    };
    EXPECT_EQ(QuantizeRadiance(encoding, most, 1), 65535);
    MakeRoomForUndershoot(&encoding);
    EXPECT_EQ(QuantizeRadiance(encoding, most, 1), 65535);
    MakeRoomBesideEdges(integers, &encoding);
    EXPECT_NEAR(kept(most), most, 0.51 / encoding.Scale());
    EXPECT_EQ(kept(1.5 * most), kept(most));
    EXPECT_EQ(QuantizeRadiance(encoding, 1, 2 * most), QuantizeRadiance(encoding, most, 1));
  }
}

TEST(PixelFootprint, NamesAreThoseOfTheKey) {
  for (const auto footprint : {PixelFootprint::kArea, PixelFootprint::kPoint})
    EXPECT_EQ(PixelFootprintOf(NameOf(footprint)), footprint);
  EXPECT_FALSE(PixelFootprintOf("dots"));
}

}  // namespace
}  // namespace lf
