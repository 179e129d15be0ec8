// SPDX-License-Identifier: Apache-2.0
// Tests weighted rays with both estimators and both back ends.
#include "lf/camera/ray_weight.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/collection/gather.h"
#include "lf/collection/scatter.h"
#include "lf/collection/test_plates.h"
#include "lf/core/random.h"

namespace lf {
namespace {

using testing::PlateFor;

// Returns random weights of blocks, some of them 0. In the upper left corner of the plate, all
// blocks have the same weight.
RayWeights AnyWeights(uint64_t seed) {
  const WeightBlocks blocks = {static_cast<int>(seed % 8), static_cast<int>(seed / 8 % 8)};
  return testing::WeightsByBlock(blocks, [seed](int x, int y) -> uint32_t {
    const auto column = static_cast<uint64_t>(x / kWeightBlock);
    const auto row = static_cast<uint64_t>(y / kWeightBlock);
    if (column < 6 && row < 4) return seed % 4 == 0 ? 0 : kMaxWeight;
    const uint64_t any = RandomBits(seed, column, row);
    return any % 5 == 0 ? 0 : static_cast<uint32_t>(any >> 32) % (kMaxWeight + 1);
  });
}

// Returns AnyWeights() with a feather that is whole, 0 or partial. Groups of three by three corners
// have the same feather.
RayWeights AnyFeatheredWeights(uint64_t seed) {
  const RayWeights any = AnyWeights(seed);
  const auto of_row = [any](int end_x, int end_y, int count, uint8_t* weights) {
    any.OfRow(end_x - 1, end_y - 1, count, weights);
  };
  return RayWeights(
      any.blocks(), of_row, [seed](int x, int y, int columns, int rows, uint16_t* feather) {
        for (int j = 0; j < rows; ++j)
          for (int i = 0; i < columns; ++i) {
            const auto column = static_cast<uint64_t>(x + i * kWeightBlock + 8) / kWeightBlock;
            const auto row = static_cast<uint64_t>(y + j * kWeightBlock + 8) / kWeightBlock;
            const uint64_t random = RandomBits(seed, column / 3, row / 3);
            feather[j * columns + i] = random % 3 == 0   ? kWholeFeather
                                       : random % 3 == 1 ? 0
                                                         : random % kWholeFeather;
          }
      });
}

// Returns `plate` with each element multiplied by its weight.
SensorPlate Multiplied(const SensorPlate& plate, const RayWeights& weights) {
  SensorPlate product(plate.width(), plate.height());
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x)
      for (int channel = 0; channel < SensorPlate::kChannels; ++channel) {
        const ElementSum rays = plate.At(x, y, channel);
        const uint64_t w = weights.At(x, y);
        product.Add(x, y, channel, {w * rays.sum, w * rays.count});
      }
  return product;
}

TEST(RayWeights, AreThoseOfBlocks) {
  const RayWeights weights = testing::WeightsByBlock(
      {3, 0}, [](int x, int y) { return static_cast<uint32_t>(10 * x + y); });
  EXPECT_EQ(weights.At(0, 0), 58u);
  EXPECT_EQ(weights.At(4, 7), 58u);
  EXPECT_EQ(weights.At(5, 7), 138u);
  EXPECT_EQ(weights.At(12, 8), 146u);
  EXPECT_FALSE(weights.are_same());
  EXPECT_EQ(RayWeights().At(5, 9), 1u);
  EXPECT_EQ(RayWeights(7).At(5, 9), 7u);
  EXPECT_TRUE(RayWeights(7).are_same());
}

TEST(RayWeights, FeatherIsInterpolatedBetweenCorners) {
  // The feather grows by a 32nd per element to the right, from 0 at x = 5.
  const auto weight = [](int, int, int count, uint8_t* weights) {
    std::fill_n(weights, count, 64);
  };
  const RayWeights weights(
      {3, 1}, weight, [](int x, int, int columns, int rows, uint16_t* feather) {
        for (int i = 0; i < columns * rows; ++i)
          feather[i] =
              static_cast<uint16_t>(std::clamp(8 * (x + i % columns * kWeightBlock - 5), 0, 256));
      });
  EXPECT_TRUE(weights.has_feather());
  EXPECT_EQ(weights.At(0, 5), 1u);  // at least 1: a recorded ray counts
  EXPECT_EQ(weights.At(5, 5), 1u);
  EXPECT_EQ(weights.At(7, 0), 5u);
  EXPECT_EQ(weights.At(12, 40), 15u);
  EXPECT_EQ(weights.At(13, 40), 17u);
  EXPECT_EQ(weights.At(36, 40), 63u);
  EXPECT_EQ(weights.At(37, 40), 64u);
  const uint16_t whole[] = {kWholeFeather, kWholeFeather}, none[] = {0, 0};
  for (int j = 0; j < kWeightBlock; ++j) {
    EXPECT_EQ(FeatheredWeight(kMaxWeight, whole, whole, j, j), kMaxWeight);
    EXPECT_EQ(FeatheredWeight(0, whole, none, j, j), 0u);
    EXPECT_EQ(FeatheredWeight(160, whole, none, 3, j), static_cast<uint32_t>(150 - 20 * j));
  }
}

TEST(RayWeights, RaysAddAndCountSoManyTimes) {
  uint64_t total = 0, most = 0;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    testing::CameraPair pair =
        seed % 3 == 0 ? testing::RandomDistortedPair(seed) : testing::RandomCameraPair(seed);
    if (seed % 4 == 1) {  // many rays on one element
      pair.render_camera.pinhole.intrinsics.fx_px *= 0.05;
      pair.render_camera.pinhole.intrinsics.fy_px *= 0.05;
    }
    const auto bayer = static_cast<BayerPattern>(seed % 5);
    const LfPixels pixels = testing::NoisePixels(testing::WholeImage(pair), bayer, seed);
    const IdealPixels ideal(pair.lf_camera.intrinsics);
    const SensorPlate empty = PlateFor(pair);
    const TileGrid grid = testing::GridOf(empty, 40, 23);
    const ScatterPlan scatter =
        PlanScatter(pair.lf_camera, pair.render_camera, pixels.rect, grid, &ideal);
    const GatherPlan gather =
        PlanGather(pair.lf_camera, pair.render_camera, {},
                   seed % 10 == 0 ? PixelFilter::kPrefiltered : PixelFilter::kBicubic);
    const LfPixels filtered =
        bayer == BayerPattern::kNone ? testing::PixelsFor(gather, pixels) : LfPixels();
    for (const bool is_gather : {false, true}) {
      if (is_gather && bayer != BayerPattern::kNone) continue;
      // With the smaller limit of TileSums (odd seeds), pieces of scanlines may be added pixel by
      // pixel.
      const auto collect = [&](const RayWeights& weights, SensorPlate* plate) {
        return testing::InTiles(
            plate, grid,
            [&](size_t tile, TileSums* sums) {
              return is_gather ? GatherTile(gather, filtered, sums, weights)
                               : ScatterTile(scatter, tile, pixels, sums, weights);
            },
            seed % 2 == 0 ? TileSums::kMaxRays : kMaxWeight);
      };
      SensorPlate plain = PlateFor(pair);
      total += collect(1, &plain);
      for (const RayWeights& weights : {RayWeights(0), RayWeights(2), RayWeights(kMaxWeight),
                                        AnyWeights(seed), AnyFeatheredWeights(seed)}) {
        SensorPlate weighted = PlateFor(pair);
        collect(weights, &weighted);
        EXPECT_EQ(weighted, Multiplied(plain, weights)) << seed;
      }
      for (int y = 0; y < plain.height(); ++y)
        for (int x = 0; x < plain.width(); ++x) most = std::max(most, plain.At(x, y, 1).count);
    }
  }
  EXPECT_GT(total, 100000u);
  EXPECT_GT(most, 10u);
}

TEST(RayWeights, TheReferencesDoTheSame) {
  const testing::CameraPair pair = testing::ParallelPair(1, 2, 0.013, 0.05);
  const LfPixels pixels = testing::NoisePixels(testing::WholeImage(pair), BayerPattern::kNone, 3);
  for (const RayWeights& weights :
       {RayWeights(1), RayWeights(100), AnyWeights(2), AnyFeatheredWeights(2)}) {
    SensorPlate plain = PlateFor(pair), weighted = PlateFor(pair);
    ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &plain);
    ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &weighted, weights);
    EXPECT_EQ(weighted, Multiplied(plain, weights));
    SensorPlate gathered = PlateFor(pair), weighted_gathered = PlateFor(pair);
    EXPECT_GT(GatherReference(pair.lf_camera, pixels, pair.render_camera, &gathered), 0u);
    GatherReference(pair.lf_camera, pixels, pair.render_camera, &weighted_gathered, weights);
    EXPECT_EQ(weighted_gathered, Multiplied(gathered, weights));
  }
}

}  // namespace
}  // namespace lf
