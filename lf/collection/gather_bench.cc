// SPDX-License-Identifier: Apache-2.0
// Measures the two steps of the fast back end of the estimator *bilinear*, PlanGather() and
// GatherTile(), for one prefiltered LF image of 2048 x 2048 pixels in one frame of 1920 x 1080 that
// gets nearly all its rays, without and with lens distortion.
#include <benchmark/benchmark.h>

#include <utility>

#include "lf/collection/bench_lenses.h"
#include "lf/collection/gather.h"
#include "lf/collection/test_plates.h"

namespace lf {
namespace {

struct GatherScene {
  PinholeCamera lf_camera;
  RenderCamera frame;
};

GatherScene MakeGatherScene(const Distortion& distortion) {
  GatherScene scene;
  scene.frame.pinhole.intrinsics = {2000, 2000, 960, 540, 0, 1920, 1080};
  scene.frame.aperture = {0.05, 0, 0};
  scene.frame.focus_plane = {Vec3::UnitZ(), 2};
  scene.lf_camera.intrinsics = {2000, 2000, 1024, 1024, 0, 2048, 2048, distortion};
  scene.lf_camera.cam_from_world = *LookAlong({0.01, 0.005, 0.003}, {0.01, 0.01, 1}, {0.02, -1, 0});
  return scene;
}

constexpr Distortion kNoDistortion{};

void BM_PlanGather(benchmark::State& state, const Distortion& distortion) {
  const GatherScene scene = MakeGatherScene(distortion);
  GatherPlan plan;
  for (auto _ : state)
    plan = PlanGather(scene.lf_camera, scene.frame, std::move(plan), PixelFilter::kPrefiltered);
  state.counters["segments"] = static_cast<double>(plan.segments.size());
}
BENCHMARK_CAPTURE(BM_PlanGather, none, kNoDistortion);
BENCHMARK_CAPTURE(BM_PlanGather, phone, kPhoneLens);
BENCHMARK_CAPTURE(BM_PlanGather, barrel, kBarrelLens);
BENCHMARK_CAPTURE(BM_PlanGather, fisheye, kFisheyeLens);

// Adds the same LF image several times before a tile is added to the plate, as the renderer does
// with a batch of LF images.
void BM_GatherTile(benchmark::State& state, const Distortion& distortion) {
  constexpr int kBatch = 16;
  const GatherScene scene = MakeGatherScene(distortion);
  const GatherPlan plan = PlanGather(scene.lf_camera, scene.frame, {}, PixelFilter::kPrefiltered);
  const LfPixels pixels =
      testing::PixelsFor(plan, testing::NoisePixels({0, 0, 2048, 2048}, BayerPattern::kNone, 1));
  SensorPlate plate(1920, 1080);
  uint64_t rays = 0;
  for (auto _ : state)
    rays += testing::InTiles(&plate, TileSums::GridOf(1920, 1080), [&](size_t, TileSums* sums) {
      uint64_t of_tile = 0;
      for (int i = 0; i < kBatch; ++i) of_tile += GatherTile(plan, pixels, sums);
      return of_tile;
    });
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(BM_GatherTile, none, kNoDistortion);
BENCHMARK_CAPTURE(BM_GatherTile, phone, kPhoneLens);
BENCHMARK_CAPTURE(BM_GatherTile, barrel, kBarrelLens);
BENCHMARK_CAPTURE(BM_GatherTile, fisheye, kFisheyeLens);

}  // namespace
}  // namespace lf
