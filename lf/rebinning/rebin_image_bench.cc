// SPDX-License-Identifier: Apache-2.0
// Measures how long it takes to compute the probabilities of the pixels of one LF image of 2048 x
// 2048 pixels, and to sort its rays into cells.
#include <benchmark/benchmark.h>

#include <cmath>

#include "lf/core/random.h"
#include "lf/rebinning/rebin_image.h"

namespace lf {
namespace {

constexpr int kSide = 2048;

// Returns an image of waves of several lengths with some noise.
LfPixels Drawn(BayerPattern bayer) {
  LfPixels pixels({0, 0, kSide, kSide}, bayer);
  const int lanes = pixels.radiance.channels();
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      double v = 20000;
      for (int wave = 512; wave >= 16; wave /= 2)
        v += 6000 * std::sqrt(wave / 512.0) * std::sin(6.28 * x / wave) * std::cos(6.28 * y / wave);
      for (int c = 0; c < std::min(lanes, 3); ++c)
        pixels.radiance.at(x, y, c) =
            static_cast<uint16_t>(v + 300 * RandomUnit(1, static_cast<uint64_t>(y) * kSide + x, c));
    }
  return pixels;
}

Slab BenchSlab() {
  Slab slab;
  slab.uv.origin_world = Vec3(0, 0, 1);
  slab.r_st_w = 1e-4;
  slab.r_uv_w = 2e-4;
  return slab;
}

PinholeCamera BenchCamera() {
  PinholeCamera camera;
  camera.intrinsics = {2000, 2000, kSide / 2., kSide / 2., 0, kSide, kSide};
  camera.cam_from_world = *LookAlong(Vec3(0.01, 0.02, 0), Vec3(0.02, 0.01, 1), -Vec3::UnitY());
  return camera;
}

void ProbabilityOnly(benchmark::State& state) {
  const LfPixels pixels = Drawn(static_cast<BayerPattern>(state.range(0)));
  const std::vector<uint16_t> table = StoredValueTable({});
  Image<uint16_t> p;
  for (auto _ : state) {
    ProbabilityMap(pixels, pixels.rect, table, {}, &p);
    benchmark::DoNotOptimize(p.pixels().data());
  }
  state.SetItemsProcessed(state.iterations() * kSide * kSide);
}

void Rebin(benchmark::State& state, bool averages_others) {
  const LfPixels pixels = Drawn(static_cast<BayerPattern>(state.range(0)));
  const std::vector<uint16_t> table = StoredValueTable({});
  RebinOptions options;
  options.averages_others = averages_others;
  ThreadPool pool(1);
  RayMap map(4000000);
  std::vector<BinnedRays> rays(1);
  uint32_t image = 0;
  for (auto _ : state) {
    rays[0].Clear();
    RebinImage(BenchSlab(), BenchCamera(), {image++ % 8}, pixels, pixels.rect, table, nullptr,
               options, nullptr, map, rays.data());
    InsertRays(rays, pool, &map);
  }
  size_t kept = 0;
  for (const auto& shard : rays[0].kept) kept += shard.size();
  state.counters["kept"] = static_cast<double>(kept) / (kSide * kSide);
  state.SetItemsProcessed(state.iterations() * kSide * kSide);
}
void RebinKept(benchmark::State& state) { Rebin(state, false); }
void RebinWithOthers(benchmark::State& state) { Rebin(state, true); }

// The argument `mosaic` is 0 for RGB, 1 for RGGB.
BENCHMARK(ProbabilityOnly)->Arg(0)->Arg(1)->ArgName("mosaic")->Unit(benchmark::kMillisecond);
BENCHMARK(RebinKept)->Arg(0)->Arg(1)->ArgName("mosaic")->Unit(benchmark::kMillisecond);
BENCHMARK(RebinWithOthers)->Arg(0)->Arg(1)->ArgName("mosaic")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lf
