// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/block_search.h"

#include <gtest/gtest.h>

#include <random>

#include "lf/pixels/prediction/brightness.h"

namespace lf {
namespace {

// Waves of several lengths and directions, so that all places look different.
double Texture(double x, double y) {
  return 128 + 40 * std::sin(0.31 * x + 0.11 * y) + 30 * std::sin(0.17 * y - 0.23 * x + 1) +
         25 * std::sin(0.052 * x * std::cos(0.3) + 0.41 * y);
}

// A camera at (x, y) sees depth index d moved by d * (x, y) pixels to the left and upwards.
PlaneWarp WarpTo(double x, double y) {
  PlaneWarp warp = IdentityWarp();
  warp.step[0] = -std::llround(x * (1 << kWarpBits));
  warp.step[1] = -std::llround(y * (1 << kWarpBits));
  return warp;
}

// Two planes: a near one, of depth 40, in the columns from 96 on, before a far one, of depth 10.
Image<uint8_t> SeenFrom(double x, double y) {
  Image<uint8_t> image(192, 96);
  for (int row = 0; row < 96; ++row)
    for (int column = 0; column < 192; ++column) {
      const double near_x = column + 40 * x, near_y = row + 40 * y;
      const double value = near_x >= 96 ? Texture(near_x, near_y)
                                        : Texture(500 + column + 10 * x, 300 + row + 10 * y);
      image.at(column, row) = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
  return image;
}

TEST(BlockSearch, FindsTheDepthsOfTwoPlanes) {
  const Image<uint8_t> target = SeenFrom(0, 0);
  const std::vector<Image<uint8_t>> references = {SeenFrom(0.25, 0), SeenFrom(-0.25, 0),
                                                  SeenFrom(0, 0.25)};
  const std::vector<PlaneWarp> warps = {WarpTo(0.25, 0), WarpTo(-0.25, 0), WarpTo(0, 0.25)};
  const BlockField found = SearchBlocks(target, references, warps, {4, 0});
  for (int row = 1; row < 5; ++row)
    for (int column = 1; column < 11; ++column) {
      const size_t block = static_cast<size_t>(row) * found.columns + column;
      EXPECT_EQ(found.depths[block], column < 6 ? 10 : 40) << row << ", " << column;
      EXPECT_NE(found.masks[block], 0);
    }
}

// Left of the edge of the near plane, the camera on the right sees the near plane.
TEST(BlockSearch, TakesTheReferenceThatSeesTheBlock) {
  const Image<uint8_t> target = SeenFrom(0, 0);
  const std::vector<Image<uint8_t>> references = {SeenFrom(0.4, 0), SeenFrom(-0.4, 0)};
  const std::vector<PlaneWarp> warps = {WarpTo(0.4, 0), WarpTo(-0.4, 0)};
  const BlockField found = SearchBlocks(target, references, warps, {4, 0});
  for (int row = 1; row < 5; ++row) {
    EXPECT_EQ(found.depths[row * found.columns + 5], 10);
    EXPECT_EQ(found.masks[row * found.columns + 5], 2);
    EXPECT_EQ(found.depths[row * found.columns + 2], 10);
  }
}

// Noise has no depth: blocks agree with their neighbours where that costs little.
TEST(BlockSearch, CoarserQuantisersGiveSmootherDepths) {
  std::mt19937 random(1);
  const auto noise = [&] {
    Image<uint8_t> image(200, 150);
    for (uint8_t& value : image.pixels()) value = static_cast<uint8_t>(120 + random() % 16);
    return image;
  };
  const Image<uint8_t> target = noise();
  const std::vector<Image<uint8_t>> references = {noise(), noise()};
  const std::vector<PlaneWarp> warps = {WarpTo(0.2, 0), WarpTo(0, 0.2)};
  const auto changes = [&](double step) {
    const BlockField found = SearchBlocks(target, references, warps, {3, step});
    int count = 0;
    for (size_t i = 1; i < found.depths.size(); ++i)
      count += found.depths[i] != found.depths[i - 1] ? 1 : 0;
    return count;
  };
  const int fine = changes(0), middle = changes(12), coarse = changes(400);
  EXPECT_GT(fine, 3 * middle / 2);
  EXPECT_EQ(coarse, 0);
}

TEST(Brightness, IsThatOfTheChannels) {
  Image<uint16_t> rgb(2, 1, 3);
  rgb.pixels() = {1000, 1000, 1000, 5000, 6000, 7000};
  const BrightnessRange range = RangeOf<uint16_t>(std::as_const(rgb).view());
  EXPECT_EQ(range.black, 1000);
  EXPECT_EQ(range.white, 7000);
  const Image<uint8_t> found = BrightnessOf<uint16_t>(std::as_const(rgb).view(), range);
  EXPECT_EQ(found.at(0, 0), 0);
  EXPECT_EQ(found.at(1, 0), 213);  // 255 * 5000 / 6000
  Image<uint8_t> squares(1, 1, 4);
  squares.pixels() = {10, 20, 30, 41};
  EXPECT_EQ(BrightnessOf<uint8_t>(std::as_const(squares).view(), {}).at(0, 0), 25);
}

}  // namespace
}  // namespace lf
