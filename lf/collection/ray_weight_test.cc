// Weighted rays, of both estimators and back ends.
#include "lf/camera/ray_weight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "lf/collection/gather.h"
#include "lf/collection/scatter.h"
#include "lf/collection/test_plates.h"

namespace lf {
namespace {

using testing::PlateFor;

constexpr uint32_t kWeights[] = {1, 2, 100, kMaxWeight};

// weight(tile) times what `plate` holds.
template <class Weight>
SensorPlate Multiplied(const SensorPlate& plate, const TileGrid& grid, const Weight& weight) {
  SensorPlate product(plate.width(), plate.height());
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x)
      for (int channel = 0; channel < SensorPlate::kChannels; ++channel) {
        const ElementSum rays = plate.At(x, y, channel);
        const uint64_t w = weight(static_cast<size_t>(grid.TileAt(x, y)));
        product.Add(x, y, channel, {w * rays.sum, w * rays.count});
      }
  return product;
}

TEST(RayWeight, RaysAddAndCountSoManyTimesInEveryTile) {
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
    const GatherPlan gather = PlanGather(pair.lf_camera, pair.render_camera);
    const auto weight = [&](size_t tile) { return kWeights[(tile + seed) % std::size(kWeights)]; };
    for (const bool is_gather : {false, true}) {
      if (is_gather && bayer != BayerPattern::kNone) continue;
      // The smallest limit: pieces of scanlines are added pixel by pixel.
      const auto collect = [&](const auto& weight_of, SensorPlate* plate) {
        return testing::InTiles(
            plate, grid,
            [&](size_t tile, TileSums* sums) {
              return is_gather ? GatherTile(gather, pixels, sums, weight_of(tile))
                               : ScatterTile(scatter, tile, pixels, sums, weight_of(tile));
            },
            seed % 2 == 0 ? TileSums::kMaxRays : kMaxWeight);
      };
      SensorPlate plain = PlateFor(pair), weighted = PlateFor(pair);
      const uint64_t rays = collect([](size_t /*tile*/) { return 1u; }, &plain);
      EXPECT_EQ(collect(weight, &weighted), rays);
      EXPECT_EQ(weighted, Multiplied(plain, grid, weight)) << seed;
      total += rays;
      for (int y = 0; y < plain.height(); ++y)
        for (int x = 0; x < plain.width(); ++x) most = std::max(most, plain.At(x, y, 1).count);
    }
  }
  EXPECT_GT(total, 100000u);
  EXPECT_GT(most, 10u);
}

TEST(RayWeight, TheReferencesDoTheSame) {
  const testing::CameraPair pair = testing::ParallelPair(1, 2, 0.013, 0.05);
  const LfPixels pixels = testing::NoisePixels(testing::WholeImage(pair), BayerPattern::kNone, 3);
  for (const uint32_t weight : kWeights) {
    SensorPlate plain = PlateFor(pair), weighted = PlateFor(pair);
    const TileGrid whole = testing::GridOf(plain, plain.width(), plain.height());
    const auto same = [&](size_t /*tile*/) { return weight; };
    ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &plain);
    ScatterReference(pair.lf_camera, pixels, pair.render_camera, pixels.rect, &weighted, weight);
    EXPECT_EQ(weighted, Multiplied(plain, whole, same));
    SensorPlate gathered = PlateFor(pair), weighted_gathered = PlateFor(pair);
    EXPECT_GT(GatherReference(pair.lf_camera, pixels, pair.render_camera, &gathered), 0u);
    GatherReference(pair.lf_camera, pixels, pair.render_camera, &weighted_gathered, weight);
    EXPECT_EQ(weighted_gathered, Multiplied(gathered, whole, same));
  }
}

}  // namespace
}  // namespace lf
