// SPDX-License-Identifier: Apache-2.0
// Tests that results are bit-identical on every instruction set.
#include "lf/collection/simd_target.h"

#include <gtest/gtest.h>

#include "lf/collection/gather.h"
#include "lf/collection/scatter.h"
#include "lf/collection/test_plates.h"
#include "lf/core/random.h"

namespace lf {
namespace {

using testing::PlateFor;

// Returns the plates of both estimators for a pair of cameras; for a mosaic only that of *nearest*.
std::vector<SensorPlate> Collect(const testing::CameraPair& pair, uint64_t seed) {
  const Intrinsics& k = pair.lf_camera.intrinsics;
  const auto bayer = static_cast<BayerPattern>(seed % 5);
  LfPixels pixels = testing::NoisePixels(testing::WholeImage(pair), bayer, seed);
  if (bayer == BayerPattern::kNone) pixels.recorded = static_cast<BayerPattern>(seed / 25 % 5);
  const IdealPixels ideal(k);
  // Weights are all 1, all equal, or different for each block of elements.
  RayWeights weights(seed % 3 == 0 ? 1 : 1 + static_cast<uint32_t>(seed % kMaxWeight));
  if (seed % 3 == 2)
    weights = testing::WeightsByBlock({static_cast<int>(seed % 8), 5}, [seed](int x, int y) {
      return static_cast<uint32_t>(RandomBits(seed, x, y) % (kMaxWeight + 1));
    });
  SensorPlate plate = PlateFor(pair);
  const TileGrid grid = testing::GridOf(plate, 40, 23);
  const ScatterPlan scatter =
      PlanScatter(pair.lf_camera, pair.render_camera, pixels.rect, grid, &ideal);
  testing::InTiles(&plate, grid, [&](size_t tile, TileSums* sums) {
    return ScatterTile(scatter, tile, pixels, sums, weights);
  });
  std::vector<SensorPlate> plates;
  plates.push_back(std::move(plate));
  if (bayer != BayerPattern::kNone) return plates;
  PixelReading reading = static_cast<PixelFilter>(seed / 5 % 6);
  if (seed % 2 == 1) reading.footprint = PixelFootprint::kPoint;
  const GatherPlan gather = PlanGather(pair.lf_camera, pair.render_camera, {}, reading);
  plates.push_back(PlateFor(pair));
  pixels = testing::PixelsFor(gather, pixels);
  testing::InTiles(&plates.back(), grid, [&](size_t /*tile*/, TileSums* sums) {
    return GatherTile(gather, pixels, sums, weights);
  });
  return plates;
}

TEST(SimdTarget, EveryTargetGivesTheSameBits) {
  const std::vector<std::string> targets = SimdTargets();
#ifdef HWY_COMPILE_ONLY_SCALAR
  ASSERT_EQ(targets.size(), 1u);
#else
  ASSERT_GE(targets.size(), 2u);
#endif
  // The kernels without vectors: EMU128 where the compiler knows vectors of any width (clang).
  EXPECT_TRUE(targets.back() == "SCALAR" || targets.back() == "EMU128") << targets.back();
  for (uint64_t seed = 0; seed < 120; ++seed) {
    testing::CameraPair pair =
        seed % 3 == 0 ? testing::RandomDistortedPair(seed) : testing::RandomCameraPair(seed);
    if (seed % 4 == 0) {  // makes elements larger than LF pixels
      pair.render_camera.pinhole.intrinsics.fx_px *= 0.3;
      pair.render_camera.pinhole.intrinsics.fy_px *= 0.3;
    }
    if (seed % 5 == 0) testing::SetRandomSurface(20, 0.4, seed, &pair.render_camera);
    ASSERT_TRUE(UseSimdTarget(""));
    const std::vector<SensorPlate> best = Collect(pair, seed);
    for (const std::string& target : targets) {
      ASSERT_TRUE(UseSimdTarget(target));
      EXPECT_EQ(Collect(pair, seed), best) << target << ", " << seed;
    }
  }
  EXPECT_FALSE(UseSimdTarget("no such target"));
  UseSimdTarget("");
}

}  // namespace
}  // namespace lf
