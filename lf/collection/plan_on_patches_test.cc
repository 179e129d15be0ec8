// SPDX-License-Identifier: Apache-2.0
// Tests the estimator *nearest* with LF cameras that have lens distortion.
#include "lf/collection/plan_on_patches.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "lf/collection/ray_model.h"
#include "lf/collection/scatter.h"
#include "lf/collection/test_plates.h"

namespace lf {
namespace {

constexpr int kWidth = 200, kHeight = 140;
constexpr PixelRect kWholeImage{0, 0, kWidth, kHeight};

using testing::DifferingCount;
using testing::PlateFor;
using testing::TotalCount;

LfPixels WholeImageNoise(BayerPattern bayer, uint64_t seed) {
  return testing::NoisePixels(kWholeImage, bayer, seed);
}

uint64_t Scatter(const testing::CameraPair& pair, const LfPixels& pixels, const PixelRect& rect,
                 const IdealPixels& ideal_pixels, int tile_height, SensorPlate* plate) {
  const TileGrid grid = testing::GridOf(*plate, 1 + 3 * tile_height, tile_height);
  const ScatterPlan plan =
      PlanScatter(pair.lf_camera, pair.render_camera, rect, grid, &ideal_pixels);
  return testing::InTiles(plate, grid, [&](size_t tile, TileSums* sums) {
    return ScatterTile(plan, tile, pixels, sums);
  });
}

TEST(PlanOnPatches, SegmentsHoldExactlyTheRaysThatTheModelAcceptsOnThePatches) {
  size_t accepted_count = 0, scenes_with_rays = 0;
  for (uint64_t seed = 0; seed < 280; ++seed) {
    const testing::CameraPair pair = testing::RandomDistortedPair(seed);
    const IdealPixels ideal(pair.lf_camera.intrinsics);
    const RayModel model(pair.lf_camera, pair.render_camera);
    const ScatterPlan plan =
        PlanScatter(pair.lf_camera, pair.render_camera, kWholeImage, {160, 120, 40, 23}, &ideal);
    Image<uint8_t> in_span(kWidth, kHeight);
    for (const Segment& segment : plan.segments)
      for (int i = 0; i < segment.count; ++i) in_span.at(segment.x_begin + i, segment.y) += 1;
    size_t accepted = 0;
    for (const IdealPatch& patch : ideal.patches())
      for (int y = patch.rect.y_begin; y < patch.rect.y_end; ++y) {
        const IdealArc arc = patch.Scanline(y);
        for (int x = arc.x_begin; x < arc.x_end; ++x) {
          const bool collected = model.CollectIdeal(arc.At(arc.Parameter(x))).has_value();
          ASSERT_EQ(in_span.at(x, y), collected ? 1 : 0) << seed << ": " << x << ", " << y;
          accepted += collected;
        }
      }
    accepted_count += accepted;
    scenes_with_rays += accepted > 0;
  }
  EXPECT_GT(scenes_with_rays, 100u);
  EXPECT_GT(accepted_count, 100000u);
}

TEST(PlanOnPatches, MostSpansAreFoundWithoutAskingTheModel) {
  // The render lens is so wide and near that it accepts most arcs as a whole.
  testing::CameraPair pair = testing::ParallelPair(1, 1, 0.01, 0.2);
  pair.render_camera.pinhole.intrinsics = {1000, 1000, 640, 360, 0, 1280, 720, {}};
  pair.lf_camera.intrinsics = {1000, 1000, 640, 360,
                               0,    1280, 720, {DistortionModel::kRadialTangential, {0.035}}};
  const IdealPixels ideal(pair.lf_camera.intrinsics);
  const ScatterPlan plan = PlanScatter(pair.lf_camera, pair.render_camera, {0, 0, 1280, 720},
                                       {1280, 720, 384, 40}, &ideal);
  size_t whole = 0;
  for (const Segment& segment : plan.segments) whole += segment.count >= 16 ? 1 : 0;
  EXPECT_GT(whole, plan.segments.size() * 9 / 10);
}

TEST(PlanOnPatches, TheFastBackEndAgreesWithTheIteratingReference) {
  uint64_t differing = 0, total = 0;
  int64_t accepted_difference = 0;
  for (uint64_t seed = 0; seed < 140; ++seed) {
    const testing::CameraPair pair = testing::RandomDistortedPair(seed);
    const auto bayer = static_cast<BayerPattern>(seed % 5);
    const LfPixels pixels = WholeImageNoise(bayer, seed);
    const IdealPixels ideal(pair.lf_camera.intrinsics);
    SensorPlate expected = PlateFor(pair), fast = PlateFor(pair);
    const uint64_t accepted =
        ScatterReference(pair.lf_camera, pixels, pair.render_camera, kWholeImage, &expected);
    const uint64_t fast_accepted = Scatter(pair, pixels, kWholeImage, ideal, 120, &fast);
    accepted_difference += std::abs(static_cast<int64_t>(accepted - fast_accepted));
    EXPECT_EQ(TotalCount(fast), fast_accepted * (bayer == BayerPattern::kNone ? 3 : 1));
    differing += DifferingCount(expected, fast);
    total += TotalCount(expected);
  }
  EXPECT_GT(total, 100000u);
  // About one ray in 10^4 lies so close to a border that the two back ends may decide differently.
  EXPECT_LE(static_cast<double>(accepted_difference), 1e-4 * static_cast<double>(total));
  EXPECT_LE(static_cast<double>(differing), 3e-4 * static_cast<double>(total));
}

TEST(PlanOnPatches, AnyCutGivesTheSameBits) {
  for (uint64_t seed = 0; seed < 70; ++seed) {
    const testing::CameraPair pair = testing::RandomDistortedPair(seed);
    const LfPixels pixels = WholeImageNoise(BayerPattern::kGrbg, seed);
    const IdealPixels ideal(pair.lf_camera.intrinsics);
    SensorPlate whole = PlateFor(pair), tiles = PlateFor(pair), parts = PlateFor(pair);
    const uint64_t accepted = Scatter(pair, pixels, kWholeImage, ideal, 120, &whole);
    EXPECT_EQ(Scatter(pair, pixels, kWholeImage, ideal, 7, &tiles), accepted);
    EXPECT_EQ(whole, tiles) << seed;
    for (const PixelRect& rect : {PixelRect{0, 0, 53, kHeight}, PixelRect{53, 0, kWidth, 31},
                                  PixelRect{53, 31, kWidth, kHeight}})
      Scatter(pair, pixels, rect, ideal, 40, &parts);
    EXPECT_EQ(whole, parts) << seed;
  }
}

}  // namespace
}  // namespace lf
