// SPDX-License-Identifier: Apache-2.0
// Compares the fast back end of the estimator *nearest* with the reference.
#include "lf/collection/scatter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/collection/ray_model.h"
#include "lf/collection/test_plates.h"

namespace lf {
namespace {

using testing::DifferingCount;
using testing::PlateFor;
using testing::TotalCount;
using testing::WholeImage;

// Tiles are about three times as wide as high, so that scanlines cross vertical and horizontal
// borders of tiles.
uint64_t ScatterInTilesOf(const testing::CameraPair& pair, const LfPixels& pixels,
                          const PixelRect& rect, int tile_height, SensorPlate* plate) {
  const TileGrid grid = testing::GridOf(*plate, 1 + 3 * tile_height, tile_height);
  const ScatterPlan plan = PlanScatter(pair.lf_camera, pair.render_camera, rect, grid);
  return testing::InTiles(plate, grid, [&](size_t tile, TileSums* sums) {
    return ScatterTile(plan, tile, pixels, sums);
  });
}

TEST(Scatter, SpansHoldExactlyTheRaysThatTheModelAccepts) {
  size_t accepted_count = 0, scenes_with_rays = 0;
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    const testing::CameraPair pair = testing::RandomCameraPair(seed);
    const RayModel model(pair.lf_camera, pair.render_camera);
    const ScatterPlan plan =
        PlanScatter(pair.lf_camera, pair.render_camera, WholeImage(pair), {160, 120, 17, 9});
    Image<uint8_t> in_span(50, 35);
    for (const Segment& segment : plan.segments)
      for (int i = 0; i < segment.count; ++i) in_span.at(segment.x_begin + i, segment.y) += 1;
    size_t accepted = 0;
    for (int y = 0; y < 35; ++y)
      for (int x = 0; x < 50; ++x) {
        const bool collected = model.Collect(x, y).has_value();
        ASSERT_EQ(in_span.at(x, y), collected ? 1 : 0) << seed << ": " << x << ", " << y;
        accepted += collected;
      }
    accepted_count += accepted;
    scenes_with_rays += accepted > 0;
  }
  EXPECT_GT(scenes_with_rays, 1000u);
  EXPECT_GT(accepted_count, 100000u);
}

TEST(Scatter, TheFastBackEndAgreesWithTheReference) {
  uint64_t differing = 0, total = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    const testing::CameraPair pair = testing::RandomCameraPair(seed);
    const auto bayer = static_cast<BayerPattern>(seed % 5);
    const LfPixels pixels = testing::NoisePixels(WholeImage(pair), bayer, seed);
    SensorPlate expected = PlateFor(pair), fast = PlateFor(pair);
    const uint64_t accepted =
        ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &expected);
    EXPECT_EQ(ScatterInTilesOf(pair, pixels, pixels.rect, 120, &fast), accepted);
    // Conservation: the counts add up to the number of accepted rays, or three times as many for
    // RGB.
    EXPECT_EQ(TotalCount(expected), accepted * (bayer == BayerPattern::kNone ? 3 : 1));
    EXPECT_EQ(TotalCount(fast), TotalCount(expected));
    differing += DifferingCount(expected, fast);
    total += TotalCount(expected);
  }
  EXPECT_GT(total, 100000u);
  EXPECT_LE(static_cast<double>(differing), 2e-4 * static_cast<double>(total));
}

TEST(Scatter, AnyCutIntoTilesGivesTheSameBits) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const testing::CameraPair pair = testing::RandomCameraPair(seed);
    const LfPixels pixels = testing::NoisePixels(WholeImage(pair), BayerPattern::kNone, seed);
    SensorPlate whole = PlateFor(pair), cut = PlateFor(pair), fine = PlateFor(pair);
    const uint64_t accepted = ScatterInTilesOf(pair, pixels, pixels.rect, 120, &whole);
    EXPECT_EQ(ScatterInTilesOf(pair, pixels, pixels.rect, 17, &cut), accepted);
    EXPECT_EQ(ScatterInTilesOf(pair, pixels, pixels.rect, 1, &fine), accepted);
    EXPECT_EQ(whole, cut) << seed;
    EXPECT_EQ(whole, fine) << seed;
  }
}

TEST(Scatter, AnyCutOfTheImageGivesTheSameBits) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const testing::CameraPair pair = testing::RandomCameraPair(seed);
    const LfPixels pixels = testing::NoisePixels(WholeImage(pair), BayerPattern::kGrbg, seed);
    SensorPlate whole = PlateFor(pair), cut = PlateFor(pair);
    ScatterInTilesOf(pair, pixels, pixels.rect, 120, &whole);
    for (const PixelRect& rect :
         {PixelRect{0, 0, 13, 35}, PixelRect{13, 0, 50, 9}, PixelRect{13, 9, 50, 35}})
      ScatterInTilesOf(pair, pixels, rect, 120, &cut);
    EXPECT_EQ(whole, cut) << seed;
  }
}

// Parallel rigs put whole scanlines exactly on borders of elements, plates and tiles, where
// rounding decides. No ray may be lost or counted twice.
TEST(Scatter, RaysOnBordersAreNeitherLostNorDoubled) {
  for (int column = -6; column <= 6; ++column)
    for (int row = -6; row <= 6; ++row) {
      // The disparity is half an element per pitch.
      const testing::CameraPair pair = testing::ParallelPair(column, row, 0.01, 0.05);
      const LfPixels pixels = testing::NoisePixels(WholeImage(pair), BayerPattern::kNone, 3);
      SensorPlate expected = PlateFor(pair), fast = PlateFor(pair), bands = PlateFor(pair);
      const uint64_t accepted =
          ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &expected);
      EXPECT_EQ(accepted > 0, column * column + row * row <= 25) << column << ", " << row;
      EXPECT_EQ(ScatterInTilesOf(pair, pixels, pixels.rect, 35, &fast), accepted);
      EXPECT_EQ(ScatterInTilesOf(pair, pixels, pixels.rect, 1, &bands), accepted);
      EXPECT_EQ(fast, bands);
      EXPECT_EQ(TotalCount(fast), 3 * accepted);
    }
}

TEST(Scatter, MaskedPixelsGiveNoRay) {
  const testing::CameraPair pair = testing::ParallelPair(1, 2, 0.013, 0.05);
  for (const BayerPattern bayer : {BayerPattern::kRggb, BayerPattern::kNone}) {
    LfPixels pixels = testing::NoisePixels(WholeImage(pair), bayer, 3);
    SensorPlate expected = PlateFor(pair), fast = PlateFor(pair), all = PlateFor(pair);
    const uint64_t unmasked = ScatterInTilesOf(pair, pixels, pixels.rect, 8, &all);
    for (int i = 5; i < 30; ++i) pixels.Mask(i, i);
    const uint64_t accepted =
        ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &expected);
    EXPECT_EQ(unmasked, accepted + 25);
    EXPECT_EQ(ScatterInTilesOf(pair, pixels, pixels.rect, 8, &fast), accepted);
    EXPECT_EQ(expected, fast);
    EXPECT_EQ(TotalCount(fast), accepted * (bayer == BayerPattern::kNone ? 3 : 1));
  }
}

TEST(Scatter, PixelsOfAPartOfTheImageAreEnough) {
  const testing::CameraPair pair = testing::ParallelPair(1, 2, 0.013, 0.05);
  const PixelRect part{7, 9, 31, 20};
  const LfPixels all = testing::NoisePixels(WholeImage(pair), BayerPattern::kGbrg, 3);
  LfPixels some = testing::NoisePixels(part, BayerPattern::kGbrg, 3);
  for (int y = part.y_begin; y < part.y_end; ++y)
    for (int x = part.x_begin; x < part.x_end; ++x)
      some.radiance.at(x - part.x_begin, y - part.y_begin) = all.radiance.at(x, y);
  SensorPlate from_all = PlateFor(pair), from_some = PlateFor(pair), reference = PlateFor(pair);
  ScatterInTilesOf(pair, all, part, 35, &from_all);
  ScatterInTilesOf(pair, some, part, 35, &from_some);
  ScatterReference(pair.lf_camera, some, pair.render_camera, part, &reference);
  EXPECT_EQ(from_all, from_some);
  EXPECT_EQ(reference, from_some);
}

// An LF pixel is as long as a hundred elements here, and scanlines pass through tiles that are far
// from their middle.
TEST(Scatter, AddressesFarFromTheMiddleOfAScanlineAreExact) {
  testing::CameraPair pair = testing::ParallelPair(0, 0, 0.01, 9);
  pair.render_camera.pinhole.intrinsics = {9000, 9000, 260, 4500, 0, 520, 9000, {}};
  pair.lf_camera.intrinsics = {90, 9000, 45, 260, 0, 90, 520, {}};
  const Mat3 quarter_turn =
      Eigen::AngleAxisd(RadiansFromDegrees(90.1), Vec3::UnitZ()).toRotationMatrix();
  pair.lf_camera.cam_from_world.rotation =
      quarter_turn * pair.lf_camera.cam_from_world.rotation.eval();
  pair.lf_camera.cam_from_world.translation =
      quarter_turn * pair.lf_camera.cam_from_world.translation.eval();
  const LfPixels pixels = testing::NoisePixels(WholeImage(pair), BayerPattern::kRggb, 3);
  SensorPlate expected = PlateFor(pair), fast = PlateFor(pair);
  const uint64_t accepted =
      ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &expected);
  EXPECT_GT(accepted, 30000u);
  const TileGrid grid = TileSums::GridOf(520, 9000);
  const ScatterPlan plan = PlanScatter(pair.lf_camera, pair.render_camera, pixels.rect, grid);
  EXPECT_EQ(testing::InTiles(
                &fast, grid,
                [&](size_t tile, TileSums* sums) { return ScatterTile(plan, tile, pixels, sums); }),
            accepted);
  EXPECT_LE(DifferingCount(expected, fast), accepted / 5000);
}

TEST(Scatter, FullWordsArePromotedWithoutLosingARay) {
  // A camera in the focus plane sends all its rays to one element.
  testing::CameraPair pair = testing::ParallelPair(0, 0, 0.01, 9);
  pair.lf_camera.cam_from_world.translation = {0.1, 0.05, -2};
  const LfPixels pixels = testing::NoisePixels(WholeImage(pair), BayerPattern::kNone, 5);
  SensorPlate expected = PlateFor(pair), fast = PlateFor(pair, 300), reference = PlateFor(pair, 10);
  const TileGrid grid = testing::GridOf(fast, 50, 35);
  const ScatterPlan plan = PlanScatter(pair.lf_camera, pair.render_camera, pixels.rect, grid);
  for (int repeat = 0; repeat < 3; ++repeat) {
    ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &expected);
    ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &reference);
    const auto collect = [&](size_t tile, TileSums* sums) {
      return ScatterTile(plan, tile, pixels, sums);
    };
    testing::InTiles(&fast, grid, collect, 70);
  }
  EXPECT_EQ(TotalCount(expected), uint64_t{3} * 3 * 50 * 35);
  EXPECT_EQ(expected, reference);
  EXPECT_EQ(expected, fast);
}

}  // namespace
}  // namespace lf
