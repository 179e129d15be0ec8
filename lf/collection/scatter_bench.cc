// SPDX-License-Identifier: Apache-2.0
// Measures the rays per second of both back ends of the estimator *nearest*, for one LF image in
// one frame that accepts nearly all its rays; also how long PlanScatter() takes, and how many
// pixels per second IdealPixels prepares.
#include <benchmark/benchmark.h>

#include "lf/collection/bench_lenses.h"
#include "lf/collection/scatter.h"
#include "lf/collection/test_plates.h"

namespace lf {
namespace {

const TileGrid kGrid = TileSums::GridOf(960, 640);

struct Scene {
  PinholeCamera lf_camera;
  RenderCamera frame;
  LfPixels pixels;
};

Scene MakeScene(BayerPattern bayer, double turn_rad) {
  Scene scene;
  scene.frame.pinhole.intrinsics = {1000, 1000, 480, 320, 0, 960, 640};
  scene.frame.aperture = {0.05, 0, 0};
  scene.frame.focus_plane = {Vec3::UnitZ(), 2};
  scene.lf_camera.intrinsics = scene.frame.pinhole.intrinsics;
  scene.lf_camera.cam_from_world =
      *LookAlong({0.01, 0.005, 0.003}, {turn_rad, 0.01, 1}, {0.02, -1, 0});
  scene.pixels = testing::NoisePixels({0, 0, 960, 640}, bayer, 1);
  return scene;
}

void ReportRays(benchmark::State& state, uint64_t accepted) {
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(accepted), benchmark::Counter::kIsRate);
}

uint64_t Scatter(const Scene& scene, const IdealPixels* ideal, SensorPlate* plate) {
  const ScatterPlan plan =
      PlanScatter(scene.lf_camera, scene.frame, scene.pixels.rect, kGrid, ideal);
  return testing::InTiles(plate, kGrid, [&](size_t tile, TileSums* sums) {
    return ScatterTile(plan, tile, scene.pixels, sums);
  });
}

void BM_Fast(benchmark::State& state, BayerPattern bayer) {
  const Scene scene = MakeScene(bayer, 0.02);
  SensorPlate plate(960, 640);
  uint64_t accepted = 0;
  for (auto _ : state) accepted += Scatter(scene, nullptr, &plate);
  ReportRays(state, accepted);
}
BENCHMARK_CAPTURE(BM_Fast, rgb, BayerPattern::kNone);
BENCHMARK_CAPTURE(BM_Fast, bayer, BayerPattern::kRggb);

// Computes ideal pixels once, before the measurement, because a render computes them once for many
// frames.
void BM_Distorted(benchmark::State& state, const Distortion& distortion) {
  Scene scene = MakeScene(BayerPattern::kNone, 0.02);
  scene.lf_camera.intrinsics.distortion = distortion;
  const IdealPixels ideal(scene.lf_camera.intrinsics);
  SensorPlate plate(960, 640);
  uint64_t accepted = 0;
  for (auto _ : state) accepted += Scatter(scene, &ideal, &plate);
  ReportRays(state, accepted);
}
BENCHMARK_CAPTURE(BM_Distorted, phone, kPhoneLens);
BENCHMARK_CAPTURE(BM_Distorted, barrel, kBarrelLens);
BENCHMARK_CAPTURE(BM_Distorted, fisheye, kFisheyeLens);

void BM_IdealPixels(benchmark::State& state, const Distortion& distortion) {
  Intrinsics k = MakeScene(BayerPattern::kNone, 0.02).lf_camera.intrinsics;
  k.distortion = distortion;
  for (auto _ : state) benchmark::DoNotOptimize(IdealPixels(k));
  ReportRays(state, state.iterations() * 960 * 640);
}
BENCHMARK_CAPTURE(BM_IdealPixels, phone, kPhoneLens);
BENCHMARK_CAPTURE(BM_IdealPixels, barrel, kBarrelLens);
BENCHMARK_CAPTURE(BM_IdealPixels, fisheye, kFisheyeLens);

void BM_Plan(benchmark::State& state) {
  const Scene scene = MakeScene(BayerPattern::kNone, 0.02);
  for (auto _ : state)
    benchmark::DoNotOptimize(PlanScatter(scene.lf_camera, scene.frame, scene.pixels.rect, kGrid));
}
BENCHMARK(BM_Plan);

void BM_Reference(benchmark::State& state) {
  const Scene scene = MakeScene(BayerPattern::kNone, 0.02);
  SensorPlate plate(960, 640);
  uint64_t accepted = 0;
  for (auto _ : state)
    accepted +=
        ScatterReference(scene.lf_camera, scene.pixels, scene.frame, scene.pixels.rect, &plate);
  ReportRays(state, accepted);
}
BENCHMARK(BM_Reference);

}  // namespace
}  // namespace lf
