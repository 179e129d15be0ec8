// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/recorded_values.h"

#include <gtest/gtest.h>

#include "lf/light_field/model/lf_pixels.h"

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
      RecordedValues(encoding, StoredValues::kUint8, PixelLayout::kRgb).Of(Row(radiance));
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
      RecordedValues(encoding, StoredValues::kUint8, PixelLayout::kGrey).Of(Row(between));
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
      RecordedValues(encoding, StoredValues::kUint16, PixelLayout::kMosaic).Of(light);
  const auto& stored = std::get<Image<uint16_t>>(image.pixels);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_EQ(stored.at(x, y), 1000 * BayerChannel(encoding.bayer, x, y) + 10 * x + y);
}

TEST(RecordedValues, PixelsWithoutLightAreMasked) {
  Image<uint16_t> light = Row({100, 200, 300});
  for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) light.at(1, 0, lane) = 0;
  const RecordedImage image = RecordedValues({}, StoredValues::kUint8, PixelLayout::kRgb).Of(light);
  EXPECT_EQ(image.mask.at(0, 0), 255);
  EXPECT_EQ(image.mask.at(1, 0), 0);
  EXPECT_EQ(image.mask.at(2, 0), 255);
}

}  // namespace
}  // namespace lf
