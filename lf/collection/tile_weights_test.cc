// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/tile_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lf/collection/simd_target.h"
#include "lf/core/random.h"

namespace lf {
namespace {

// Returns a feather that is whole, 0, nearly one of both, or anything between.
uint16_t AnyFeather(uint64_t random) {
  const auto between = static_cast<uint16_t>(random / 8 % (kWholeFeather + 1));
  const uint16_t some[] = {kWholeFeather, kWholeFeather, 0, 0, kWholeFeather - 1, 1,
                           between,       between};
  return some[random % 8];
}

TEST(TileWeights, RowsOfBlocksAreThoseOfTheReferenceOnEveryTarget) {
  constexpr size_t kMostBlocks = 70;
  size_t feathered = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    RandomSequence random(seed);
    const auto any = [&](int end) { return static_cast<int>(random.Uniform(0, end)); };
    const size_t count = 1 + static_cast<size_t>(any(kMostBlocks));
    std::vector<uint8_t> weights;
    std::vector<uint16_t> above, below;
    // Parts of the row are alike, so that whole vectors need no feather.
    for (size_t k = 0; k < count + 1; ++k) {
      const bool is_new = k == 0 || any(4) == 0;
      const auto add = [&](uint16_t other, std::vector<uint16_t>* of) {
        of->push_back(is_new ? other : of->back());
      };
      add(AnyFeather(RandomBits(seed, k, 0)), &above);
      add(AnyFeather(RandomBits(seed, k, 1)), &below);
      if (k < count) weights.push_back(static_cast<uint8_t>(any(3) == 0 ? any(3) : any(256)));
    }
    const bool has_feather = any(5) > 0;
    const int j_begin = any(kWeightBlock), j_end = j_begin + 1 + any(kWeightBlock - j_begin);
    const auto pitch = static_cast<ptrdiff_t>(count) * kWeightBlock + any(9);
    const auto fill = [&](const auto& how) {
      std::vector<uint8_t> of_blocks = weights;
      std::vector<uint8_t> bytes(static_cast<size_t>(pitch) * (j_end - j_begin), 99);
      how({of_blocks, has_feather ? above.data() : nullptr, has_feather ? below.data() : nullptr},
          j_begin, j_end, pitch, bytes.data());
      return bytes;
    };
    const std::vector<uint8_t> wanted = fill(FillBlocksReference);
    for (const std::string& target : SimdTargets()) {
      ASSERT_TRUE(UseSimdTarget(target));
      EXPECT_EQ(fill(FillBlocks), wanted) << target << ", " << seed;
    }
    UseSimdTarget("");
    if (!has_feather) continue;
    for (size_t k = 0; k < count; ++k)
      feathered += wanted[k * kWeightBlock] > 1 && wanted[k * kWeightBlock] < weights[k];
  }
  EXPECT_GT(feathered, 1000u);
}

// Weights whose blocks and corners depend on their place on the plate only.
RayWeights AnyWeightsOfTile(uint64_t seed) {
  const auto of_row = [seed](int end_x, int end_y, int count, uint8_t* weights) {
    for (int i = 0; i < count; ++i)
      weights[i] = static_cast<uint8_t>(
          seed % 3 == 0 ? 77 : RandomBits(seed, end_x + i * kWeightBlock, end_y) % 256);
  };
  const WeightBlocks blocks = {static_cast<int>(seed % 8), static_cast<int>(seed / 8 % 8)};
  if (seed % 5 == 0) return RayWeights(blocks, of_row);
  return RayWeights(blocks, of_row, [seed](int x, int y, int columns, int rows, uint16_t* feather) {
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        feather[j * columns + i] = seed % 4 == 0
                                       ? kWholeFeather
                                       : AnyFeather(RandomBits(seed, x + i * kWeightBlock + 100,
                                                               y + j * kWeightBlock + 100));
  });
}

TEST(TileWeights, AreThoseOfTheirElements) {
  size_t same = 0, different = 0;
  TileWeights of_tile;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    RandomSequence random(seed);
    const auto any = [&](int end) { return static_cast<int>(random.Uniform(0, end)); };
    const RayWeights weights = AnyWeightsOfTile(seed);
    const int left = any(100), top = any(100);
    const PixelRect tile = {left, top, left + 1 + any(90), top + 1 + any(40)};
    PixelRect rays = tile;
    if (seed % 2 == 0) {
      rays.x_begin += any(tile.width());
      rays.y_begin += any(tile.height());
      rays.x_end -= any(rays.width());
      rays.y_end -= any(rays.height());
    }
    const int pitch = tile.width() + kWeightBlock;
    of_tile.Fill(weights, rays, tile, pitch);
    const bool is_same = of_tile.least() == of_tile.most();
    (is_same ? same : different) += 1;
    for (int y = rays.y_begin; y < rays.y_end; ++y)
      for (int x = rays.x_begin; x < rays.x_end; ++x) {
        const uint32_t weight =
            is_same ? of_tile.most() : of_tile.data()[(y - top) * pitch + (x - left)];
        ASSERT_EQ(weight, weights.At(x, y)) << seed << ", " << x << ", " << y;
        EXPECT_LE(of_tile.least(), weight);
        EXPECT_LE(weight, of_tile.most());
      }
  }
  EXPECT_GT(same, 20u);
  EXPECT_GT(different, 100u);
}

}  // namespace
}  // namespace lf
