// SPDX-License-Identifier: Apache-2.0
// Rays of frames with a focal surface, which are collected piece by piece.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/gather.h"
#include "lf/collection/scatter.h"
#include "lf/collection/test_plates.h"

namespace lf {
namespace {

using testing::CameraPair;
using testing::PlateFor;

CameraPair SurfacePair(uint64_t seed) {
  return seed % 2 == 0 ? testing::RandomCameraPair(seed / 2)
                       : testing::RandomDistortedPair(seed / 2);
}

LfPixels RandomPixels(const CameraPair& pair, uint64_t seed) {
  LfPixels pixels = testing::NoisePixels(testing::WholeImage(pair), BayerPattern::kNone, seed);
  pixels.recorded = static_cast<BayerPattern>(seed % 5);
  return pixels;
}

uint64_t GatherSurface(const CameraPair& pair, const LfPixels& recorded, int tile_height,
                       const PixelReading& reading, SensorPlate* plate) {
  const GatherPlan plan = PlanGather(pair.lf_camera, pair.render_camera, {}, reading);
  const LfPixels pixels = testing::PixelsFor(plan, recorded);
  return testing::InTiles(plate, testing::GridOf(*plate, 1 + 3 * tile_height, tile_height),
                          [&](size_t, TileSums* sums) { return GatherTile(plan, pixels, sums); });
}

uint64_t ScatterSurface(const CameraPair& pair, const LfPixels& pixels, int tile_side,
                        SensorPlate* plate) {
  std::optional<IdealPixels> ideal;
  if (pair.lf_camera.intrinsics.has_distortion()) ideal.emplace(pair.lf_camera.intrinsics);
  const TileGrid grid = testing::GridOf(*plate, tile_side, tile_side);
  const ScatterPlan plan =
      PlanScatter(pair.lf_camera, pair.render_camera, pixels.rect, grid, ideal ? &*ideal : nullptr);
  return testing::InTiles(plate, grid, [&](size_t tile, TileSums* sums) {
    return ScatterTile(plan, tile, pixels, sums);
  });
}

// Returns the pair without its surface, focused on the plane of its first piece.
CameraPair OnPlane(const CameraPair& pair) {
  CameraPair flat = pair;
  flat.render_camera = FocusedAsAt(pair.render_camera, 0, 0);
  return flat;
}

PixelFilter SurfaceFilterOf(uint64_t seed) { return static_cast<PixelFilter>(seed % 6); }

// The cut into pieces is exact: if all of them have one plane, the frame has the same bits.
TEST(SurfacePieces, PiecesOfOnePlaneMakeTheSameBitsAsThePlane) {
  size_t scenes_of_gather = 0, scenes_of_scatter = 0;
  for (uint64_t seed = 0; seed < 80; ++seed) {
    CameraPair pair = SurfacePair(seed);
    if (!testing::SetRandomSurface(8 + static_cast<int>(seed % 53), 0, seed, &pair.render_camera))
      continue;
    const CameraPair flat = OnPlane(pair);
    const LfPixels pixels = RandomPixels(pair, seed);
    SensorPlate whole = PlateFor(pair), pieces = PlateFor(pair);
    const uint64_t rays = GatherSurface(flat, pixels, 120, SurfaceFilterOf(seed / 2), &whole);
    EXPECT_EQ(GatherSurface(pair, pixels, 25, SurfaceFilterOf(seed / 2), &pieces), rays);
    EXPECT_EQ(whole, pieces) << seed;
    scenes_of_gather += rays > 0;
    if (pair.lf_camera.intrinsics.has_distortion()) continue;
    SensorPlate whole_of_nearest = PlateFor(pair), pieces_of_nearest = PlateFor(pair);
    const uint64_t nearest = ScatterSurface(flat, pixels, 160, &whole_of_nearest);
    EXPECT_EQ(ScatterSurface(pair, pixels, 31, &pieces_of_nearest), nearest);
    EXPECT_EQ(whole_of_nearest, pieces_of_nearest) << seed;
    scenes_of_scatter += nearest > 0;
  }
  EXPECT_GT(scenes_of_gather, 12u);
  EXPECT_GT(scenes_of_scatter, 5u);
}

TEST(SurfacePieces, TheFastBackEndsAgreeWithTheReferences) {
  uint64_t total = 0, differing = 0, total_of_nearest = 0, differing_of_nearest = 0;
  for (uint64_t seed = 0; seed < 48; ++seed) {
    CameraPair pair = SurfacePair(seed);
    if (!testing::SetRandomSurface(30 + static_cast<int>(seed % 29), 0.5, seed,
                                   &pair.render_camera))
      continue;
    const LfPixels pixels = RandomPixels(pair, seed);
    SensorPlate expected = PlateFor(pair), fast = PlateFor(pair);
    total += 3 * GatherReference(pair.lf_camera, pixels, pair.render_camera, &expected, 1,
                                 PixelFilter::kBicubic);
    GatherSurface(pair, pixels, 40, PixelFilter::kBicubic, &fast);
    for (int y = 0; y < expected.height(); ++y)
      for (int x = 0; x < expected.width(); ++x)
        for (int c = 0; c < 3; ++c) {
          const ElementSum a = expected.At(x, y, c), b = fast.At(x, y, c);
          differing += a.count != b.count;
          if (a.count != b.count || a.count == 0) continue;
          EXPECT_NEAR(static_cast<double>(a.sum) / static_cast<double>(a.count),
                      static_cast<double>(b.sum) / static_cast<double>(b.count), 65535.0 / 128);
        }
    SensorPlate expected_nearest = PlateFor(pair), fast_nearest = PlateFor(pair);
    total_of_nearest += 3 * ScatterReference(pair.lf_camera, pixels, pair.render_camera,
                                             pixels.rect, &expected_nearest);
    ScatterSurface(pair, pixels, 48, &fast_nearest);
    differing_of_nearest += testing::DifferingCount(expected_nearest, fast_nearest);
  }
  EXPECT_GT(total, 20000u);
  EXPECT_LE(static_cast<double>(differing), 2e-5 * static_cast<double>(total));
  EXPECT_GT(total_of_nearest, 5000u);
  EXPECT_LE(static_cast<double>(differing_of_nearest),
            4e-4 * static_cast<double>(total_of_nearest));
}

// Brute force: each element of a frame with a surface has the ray that it has in a frame whose
// whole plate is focused on the element's own point.
TEST(SurfacePieces, EachElementHasTheRayOfAFrameFocusedOnItsPoint) {
  size_t tested = 0;
  for (const uint64_t seed : {4u, 6u, 7u, 10u, 11u, 16u}) {
    CameraPair pair = SurfacePair(seed);
    if (!testing::SetRandomSurface(16, 0.3, seed, &pair.render_camera)) continue;
    const LfPixels pixels = RandomPixels(pair, seed);
    SensorPlate plate = PlateFor(pair);
    GatherReference(pair.lf_camera, pixels, pair.render_camera, &plate, 1, PixelFilter::kBilinear);
    for (int y = 3; y < plate.height(); y += 23)
      for (int x = 5; x < plate.width(); x += 19) {
        CameraPair flat = pair;
        flat.render_camera = FocusedAsAt(pair.render_camera, x + 0.5, y + 0.5);
        const double depth_w = 1 / pair.render_camera.surface->PieceAt(x, y).At(x + 0.5, y + 0.5);
        flat.render_camera.focus_plane =
            FocusPlane(flat.render_camera.pinhole, depth_w, FocusTilt());
        SensorPlate of_element = PlateFor(pair);
        GatherReference(pair.lf_camera, pixels, flat.render_camera, &of_element, 1,
                        PixelFilter::kBilinear);
        const ElementSum a = plate.At(x, y, 1), b = of_element.At(x, y, 1);
        EXPECT_EQ(a.count, b.count);
        // One step of the interpolation's weights.
        EXPECT_NEAR(static_cast<double>(a.sum), static_cast<double>(b.sum), 65535.0 / 128);
        tested += a.count > 0;
      }
  }
  EXPECT_GT(tested, 40u);
}

}  // namespace
}  // namespace lf
