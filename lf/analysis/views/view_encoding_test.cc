// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/views/view_encoding.h"

#include <gtest/gtest.h>

#include "lf/light_field/model/lf_light.h"

namespace lf {
namespace {

TEST(EncodingOfLight, IsTheRecordedOneWithoutWhiteBalanceAndColours) {
  RadianceEncoding recorded;
  EXPECT_EQ(EncodingOfLight(recorded).max_radiance, 1);
  EXPECT_EQ(EncodingOfLight(recorded).pedestal, 0);
  recorded.transfer = Transfer::kSrgb;
  recorded.max_radiance = 16;
  recorded.pedestal = 1024;
  const RadianceEncoding light = EncodingOfLight(recorded);
  EXPECT_EQ(light.transfer, Transfer::kLinear);
  EXPECT_EQ(light.max_radiance, 16);
  EXPECT_EQ(light.pedestal, 1024);
}

TEST(EncodingOfLight, KeepsTheBrightestAndTheDarkestLight) {
  RadianceEncoding recorded;
  recorded.max_radiance = 2;
  recorded.pedestal = 2048;
  recorded.white_balance = {1.9, 1, 1.6};
  recorded.linear_srgb_from_camera << 1.6, -0.5, -0.1, -0.2, 1.5, -0.3, 0, -0.6, 1.6;
  const RadianceEncoding encoding = EncodingOfLight(recorded);
  for (int corner = 0; corner < 8; ++corner) {
    LfPixels pixels({0, 0, 1, 1}, BayerPattern::kNone);
    for (int c = 0; c < 3; ++c)
      pixels.radiance.at(0, 0, c) = (corner >> c & 1) != 0 ? uint16_t{65535} : uint16_t{0};
    const Image<float> light = LightOf(pixels, recorded, 0);
    for (const float value : light.pixels()) {
      const uint16_t stored = QuantizeRadiance(encoding, value, 1);
      EXPECT_NEAR((stored - encoding.pedestal) / encoding.Scale(), value, 1 / encoding.Scale());
    }
  }
}

}  // namespace
}  // namespace lf
