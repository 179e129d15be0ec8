// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/recorded_values.h"

#include <gtest/gtest.h>

#include <variant>
#include <vector>

#include "lf/light_field/model/lf_pixels.h"
#include "lf/storage/load/ordered_half.h"

namespace lf {
namespace {

// Returns an image with one row of pixels whose three colours are `values`.
Image<uint16_t> Row(const std::vector<uint16_t>& values) {
  Image<uint16_t> row(static_cast<int>(values.size()), 1, LfPixels::kRgbLanes, 1);
  for (size_t x = 0; x < values.size(); ++x)
    for (int c = 0; c < 3; ++c) row.at(static_cast<int>(x), 0, c) = values[x];
  return row;
}

TEST(RecordedValues, EveryStoredValueComesBack) {
  RadianceEncoding encoding;
  encoding.pedestal = 1024;
  encoding.max_radiance = 2;
  const std::vector<uint16_t> radiance = RadianceTable(encoding, 8, 1);
  const RecordedImage image =
      RecordedValues(encoding, {StoredValues::kUint8, PixelLayout::kRgb}).Of(Row(radiance));
  const auto& stored = std::get<Image<uint8_t>>(image.pixels);
  for (int value = 0; value < 256; ++value)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(stored.at(value, 0, c), value);
  EXPECT_TRUE(image.mask.empty());
}

TEST(RecordedValues, RadianceBetweenStoredValuesTakesTheNearest) {
  const RadianceEncoding encoding;
  const std::vector<uint16_t> radiance = RadianceTable(encoding, 8, 1);
  std::vector<uint16_t> between;
  for (int v = 0; v < 65536; v += 13) between.push_back(static_cast<uint16_t>(v));
  const RecordedImage image =
      RecordedValues(encoding, {StoredValues::kUint8, PixelLayout::kGrey}).Of(Row(between));
  const auto& stored = std::get<Image<uint8_t>>(image.pixels);
  for (size_t i = 0; i < between.size(); ++i) {
    int least = 65536;
    for (const uint16_t of_value : radiance)
      least = std::min(least, std::abs(of_value - between[i]));
    EXPECT_EQ(std::abs(radiance[stored.at(static_cast<int>(i), 0)] - between[i]), least);
  }
}

TEST(RecordedValues, AMosaicKeepsTheColourOfEachPixel) {
  RadianceEncoding encoding;
  encoding.bayer = BayerPattern::kGrbg;
  encoding.transfer = Transfer::kLinear;
  Image<uint16_t> light(4, 4, LfPixels::kRgbLanes, 1);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 3; ++c) light.at(x, y, c) = static_cast<uint16_t>(1000 * c + 10 * x + y);
  const RecordedImage image =
      RecordedValues(encoding, {StoredValues::kUint16, PixelLayout::kMosaic}).Of(light);
  const auto& stored = std::get<Image<uint16_t>>(image.pixels);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_EQ(stored.at(x, y), 1000 * BayerChannel(encoding.bayer, x, y) + 10 * x + y);
}

TEST(RecordedValues, PixelsWithoutLightAreMasked) {
  Image<uint16_t> light = Row({100, 200, 300});
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) light.at(1, 0, lane) = 0;
  const RecordedImage image =
      RecordedValues({}, {StoredValues::kUint8, PixelLayout::kRgb}).Of(light);
  EXPECT_EQ(image.mask.at(0, 0), 255);
  EXPECT_EQ(image.mask.at(1, 0), 0);
  EXPECT_EQ(image.mask.at(2, 0), 255);
}

// Returns light over black whose opacity is different in each pixel of a row, from 0 to 1.
Image<uint16_t> RowOfOpacities(const RadianceEncoding& encoding, double radiance) {
  constexpr int kCount = 256;
  Image<uint16_t> row(kCount, 1, LfPixels::kRgbLanes);
  for (int x = 0; x < kCount; ++x) {
    const double opacity = x / (kCount - 1.0);
    for (int c = 0; c < 3; ++c)
      row.at(x, 0, c) = QuantizeRadiance(encoding, opacity * radiance / (1 + c), 1);
    row.at(x, 0, LfPixels::kRayLane) = static_cast<uint16_t>(1.5 + kMostOpacity * opacity);
  }
  return row;
}

// Compares light that is loaded over black and opacities with those that were stored
// (storage/load/opacities.h).
TEST(RecordedValues, LightAndOpacitiesComeBackUpToTheirSteps) {
  for (const StoredValues values :
       {StoredValues::kUint8, StoredValues::kUint16, StoredValues::kHalf})
    for (const AlphaMeaning alpha : {AlphaMeaning::kStraight, AlphaMeaning::kPremultiplied}) {
      RadianceEncoding encoding;
      encoding.alpha = alpha;
      encoding.background = {0, 1, 0};
      encoding.pedestal = 2000;
      encoding.max_radiance = 2;
      constexpr double kGain = 2;
      const Image<uint16_t> light = RowOfOpacities(encoding, 1.5);
      const RecordedImage image =
          RecordedValues(encoding, {values, PixelLayout::kRgb}).Of(light, kGain);
      EXPECT_TRUE(image.mask.empty());
      const int bits = values == StoredValues::kUint8 ? 8 : 16;
      const std::vector<uint16_t> table = RadianceTable(encoding, bits, kGain);
      for (int x = 0; x < light.width(); ++x) {
        EXPECT_NEAR(image.opacities.at(x, 0), light.at(x, 0, LfPixels::kRayLane), 1) << x;
        const double opacity = (image.opacities.at(x, 0) - 1.0) / kMostOpacity;
        for (int c = 0; c < 3; ++c) {
          double colour = 0, step = 2;
          if (const auto* bytes = std::get_if<Image<uint8_t>>(&image.pixels)) {
            const size_t stored = bytes->at(x, 0, c);
            colour = table[stored];
            step += stored < 255 ? table[stored + 1] - table[stored] : 0;
          } else {
            const uint16_t word = std::get<Image<uint16_t>>(image.pixels).at(x, 0, c);
            colour = values == StoredValues::kHalf
                         ? QuantizeRadiance(encoding, double{FloatOfOrdered(word)}, kGain)
                         : table[word];
            step += values == StoredValues::kHalf ? 0x1p-11 * (colour - encoding.pedestal) : 0;
          }
          const double share = alpha == AlphaMeaning::kStraight ? opacity : 1;
          const double loaded = encoding.pedestal + share * (colour - encoding.pedestal);
          EXPECT_NEAR(loaded, light.at(x, 0, c), share * step + 1)
              << NameOf(alpha) << " " << bits << " " << x << " " << c;
        }
      }
    }
}

TEST(RecordedValues, MaskedPixelsStayDifferentFromTransparentOnes) {
  RadianceEncoding encoding;
  encoding.alpha = AlphaMeaning::kStraight;
  Image<uint16_t> light = Row({100, 200, 300});
  light.at(0, 0, LfPixels::kRayLane) = kOpaqueOpacity;
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) light.at(1, 0, lane) = 0;
  const RecordedImage image =
      RecordedValues(encoding, {StoredValues::kUint8, PixelLayout::kRgb}).Of(light);
  EXPECT_TRUE(image.mask.empty());
  EXPECT_EQ(image.opacities.at(0, 0), kOpaqueOpacity);
  EXPECT_EQ(image.opacities.at(1, 0), kMaskedOpacity);
  EXPECT_EQ(image.opacities.at(2, 0), 1) << "transparent";
}

TEST(RecordedValues, OpaqueImagesHaveNoOpacities) {
  RadianceEncoding encoding;
  encoding.alpha = AlphaMeaning::kPremultiplied;
  Image<uint16_t> light = Row({100, 200, 300});
  for (int x = 0; x < 3; ++x) light.at(x, 0, LfPixels::kRayLane) = kOpaqueOpacity;
  EXPECT_TRUE(RecordedValues(encoding, {StoredValues::kUint8, PixelLayout::kRgb})
                  .Of(light)
                  .opacities.empty());
}

// Returns a light field whose LF cameras have these gains and this falloff in the corners.
LightField FieldOf(const std::vector<ChannelGains>& gains, double corner) {
  LightField field;
  Intrinsics k{100, 100, 32, 24, 0, 64, 48};
  k.vignetting = {{corner - 1, 0, 0}};
  field.intrinsics.push_back(k);
  for (const ChannelGains& gain : gains) {
    field.cameras.emplace_back();
    field.cameras.back().gain = gain;
  }
  field.encoding.max_radiance = 16;
  return field;
}

TEST(GainsToHold, AreThoseOfTheBrightestSourceInItsDarkestCorner) {
  const std::vector<WeightedPoint> sources = {{0, 0.5}, {2, 0.5}};
  EXPECT_EQ(GainsToHold(FieldOf({1, 4, 1}, 1), sources), ChannelGains(1));
  EXPECT_EQ(GainsToHold(FieldOf({3, 4, {1, 2, 5}}, 1), sources), ChannelGains(3, 3, 5));
  EXPECT_EQ(GainsToHold(FieldOf({3, 4, 1}, 0.5), sources), ChannelGains(6));
  EXPECT_EQ(GainsToHold(FieldOf({0.25F, 4, 0.5F}, 1), sources), ChannelGains(0.5F));
}

TEST(GainsToHold, AreNoLargerThanTheLightThatIsKeptRequires) {
  const std::vector<WeightedPoint> sources = {{0, 1}};
  LightField field = FieldOf({100}, 1);
  EXPECT_EQ(GainsToHold(field, sources), ChannelGains(16));
  field.encoding.max_radiance = 0.5;
  EXPECT_EQ(GainsToHold(field, sources), ChannelGains(1));
  field.encoding.transfer = Transfer::kResponse;
  field.encoding.response = {0, 0.1, 0.25};
  EXPECT_EQ(GainsToHold(field, sources), ChannelGains(2));
  // Values below black reach as far as the pedestal.
  field.encoding = {};
  field.encoding.transfer = Transfer::kLinear;
  field.encoding.black_level = 6553.5;
  field.encoding.pedestal = 32767;
  EXPECT_NEAR(GainsToHold(field, sources)[0], 9, 0.01);
}

// Stores the brightest and the darkest light that sources with gains record, and compares the
// 16-bit radiance that is loaded with it.
TEST(RecordedValues, HoldAllLightOfSourcesWithGains) {
  for (const StoredValues values :
       {StoredValues::kUint8, StoredValues::kUint16, StoredValues::kHalf})
    for (const Transfer transfer : {Transfer::kSrgb, Transfer::kLinear}) {
      LightField field = FieldOf({3, {0.5F, 3, 4}}, 0.8);
      field.encoding.transfer = transfer;
      field.encoding.black_level = 20;
      field.encoding.pedestal = 4096;
      field.encoding.max_radiance = 4;
      const ChannelGains gains = GainsToHold(field, std::vector<WeightedPoint>{{0, 1}, {1, 1}});
      const int bits = values == StoredValues::kUint8 ? 8 : 16;
      const uint16_t most =
          QuantizeRadiance(field.encoding, LightTable(field.encoding, bits).back(), 3 / 0.8);
      const uint16_t least =
          QuantizeRadiance(field.encoding, LightTable(field.encoding, bits).front(), 3 / 0.8);
      const RecordedImage image =
          RecordedValues(field.encoding, {values, PixelLayout::kRgb}).Of(Row({least, most}), gains);
      const auto light_of = [&](int x, int c) -> double {
        if (const auto* bytes = std::get_if<Image<uint8_t>>(&image.pixels))
          return LightTable(field.encoding, 8)[bytes->at(x, 0, c)];
        const uint16_t word = std::get<Image<uint16_t>>(image.pixels).at(x, 0, c);
        return values == StoredValues::kHalf ? double{FloatOfOrdered(word)}
                                             : LightTable(field.encoding, 16)[word];
      };
      for (int c = 0; c < 3; ++c)
        for (int x = 0; x < 2; ++x) {
          const uint16_t loaded =
              QuantizeRadiance(field.encoding, light_of(x, c), gains[static_cast<size_t>(c)]);
          EXPECT_NEAR(loaded, x == 0 ? least : most, 65536 / 256) << c << " " << x;
        }
    }
}

TEST(RecordedValues, OfMixedLfImagesAreOfTheKindThatHoldsThemAll) {
  const StoredKind grey8 = {StoredValues::kUint8, PixelLayout::kGrey};
  const StoredKind rgb16 = {StoredValues::kUint16, PixelLayout::kRgb};
  const StoredKind grey_half = {StoredValues::kHalf, PixelLayout::kGrey};
  EXPECT_EQ(KindToHold(grey8, rgb16).values, StoredValues::kUint16);
  EXPECT_EQ(KindToHold(grey8, rgb16).layout, PixelLayout::kRgb);
  EXPECT_EQ(KindToHold(rgb16, grey_half).values, StoredValues::kHalf);
  EXPECT_EQ(KindToHold(rgb16, grey_half).layout, PixelLayout::kRgb);
}

}  // namespace
}  // namespace lf
