// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/squeeze_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/film/develop/display.h"

namespace lf {
namespace {

TEST(SqueezeView, TheWholePictureIsInTheTile) {
  // Light grows from 0 at the left border to 1 at the right one, and from 0 to 1 downwards.
  Image<float> view(40, 9, 2);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 40; ++x) {
      view.at(x, y, 0) = static_cast<float>((x + 0.5) / 40);
      view.at(x, y, 1) = static_cast<float>((y + 0.5) / 9);
    }
  const auto squeezed = std::get<Image<float>>(Squeezed(view, 25, 9));
  ASSERT_EQ(squeezed.width(), 25);
  ASSERT_EQ(squeezed.height(), 9);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 25; ++x) {
      EXPECT_NEAR(squeezed.at(x, y, 0), (x + 0.5) / 25, 0.004);
      EXPECT_NEAR(squeezed.at(x, y, 1), (y + 0.5) / 9, 1e-6);
    }
}

TEST(SqueezeView, LightIsKept) {
  Image<float> view(7, 5, 1, 0.0F);
  view.at(3, 2) = 1;
  const auto squeezed = std::get<Image<float>>(Squeezed(view, 4, 3));
  double sum = 0;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) sum += squeezed.at(x, y);
  EXPECT_NEAR(sum / (4 * 3), 1.0 / (7 * 5), 1e-6);
}

TEST(SqueezeView, DisplayValuesAreMixedAsLight) {
  Image<uint8_t> view(2, 1, 3, 0);
  for (int c = 0; c < 3; ++c) view.at(1, 0, c) = 255;
  const auto squeezed = std::get<Image<uint8_t>>(Squeezed(view, 1, 1));
  const auto half = static_cast<int>(std::floor(255 * DisplayFromLinear(0.5) + 0.5));
  EXPECT_EQ(squeezed.at(0, 0, 1), half);
  EXPECT_EQ(half, 188);
}

TEST(SqueezeView, ATransparentPixelHasNoColour) {
  Image<uint16_t> view(2, 1, 4, 0);
  for (int c = 0; c < 4; ++c) view.at(0, 0, c) = 65535;
  view.at(1, 0, 0) = 12345;  // red behind an alpha of 0
  const auto squeezed = std::get<Image<uint16_t>>(Squeezed(view, 1, 1));
  for (int c = 0; c < 3; ++c) EXPECT_EQ(squeezed.at(0, 0, c), 65535);
  EXPECT_EQ(squeezed.at(0, 0, 3), 32768);
}

TEST(SqueezeView, TheSameSizeKeepsAllValues) {
  Image<uint8_t> view(16, 16, 1);
  for (int i = 0; i < 256; ++i) view.at(i % 16, i / 16) = static_cast<uint8_t>(i);
  const auto same = std::get<Image<uint8_t>>(Squeezed(view, 16, 16));
  for (int i = 0; i < 256; ++i) EXPECT_EQ(same.at(i % 16, i / 16), i);
}

}  // namespace
}  // namespace lf
