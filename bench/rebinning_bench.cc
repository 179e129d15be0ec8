// SPDX-License-Identifier: Apache-2.0
// Compares rebinning with its peers on the same work in the same run: cells in a hash map
// (sparsehash, which the thesis used), and a frame of 1920 x 1080 with 16 lens points (a k-d tree,
// nanoflann).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <google/dense_hash_map>
#include <google/sparse_hash_map>

#include "lf/core/random.h"
#include "lf/rebinning/ray_map.h"
#include "lf/rebinning/splat.h"

namespace lf {
namespace {

// Returns rays in the order in which LF images yield them: one image after the other, and row by
// row in each image. One pixel in six is kept.
std::vector<BinnedRay> RaysOfImages(size_t count) {
  constexpr int kWidth = 1024, kHeight = 768;
  Slab slab;
  slab.r_st_w = slab.r_uv_w = 1;
  std::vector<BinnedRay> rays;
  for (uint64_t image = 0; rays.size() < count; ++image) {
    RandomSequence random(image);
    const double s = random.Uniform(0, 200), t = random.Uniform(0, 200);
    const double u0 = random.Uniform(0, 100), v0 = random.Uniform(0, 100);
    for (int pixel = 0; pixel < kWidth * kHeight && rays.size() < count; ++pixel) {
      const uint64_t bits = RandomBits(7, image, pixel);
      if (bits % 6 != 0) continue;
      const SlabPoint point(s, t, u0 + pixel % kWidth, v0 + static_cast<double>(pixel) / kWidth);
      rays.push_back({*CellOf(slab, point),
                      {static_cast<uint16_t>(bits >> 8), static_cast<uint16_t>(bits >> 24),
                       static_cast<uint16_t>(bits >> 40)}});
    }
  }
  return rays;
}

void Rate(benchmark::State& state, size_t count) {
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(count));
}

void InsertOurs(benchmark::State& state) {
  const std::vector<BinnedRay> rays = RaysOfImages(static_cast<size_t>(state.range(0)));
  for (auto _ : state) {
    RayMap map(rays.size());
    // The rays are added in batches that are sorted by shard, with some thousands of rays for each
    // shard, as rays of LF images are.
    constexpr size_t kBatch = 1 << 17;
    std::array<std::vector<BinnedRay>, RayMap::kShards> shards;
    for (size_t begin = 0; begin < rays.size(); begin += kBatch) {
      for (auto& shard : shards) shard.clear();
      for (size_t i = begin; i < std::min(begin + kBatch, rays.size()); ++i)
        shards[RayMap::ShardOf(rays[i].cell)].push_back(rays[i]);
      for (size_t shard = 0; shard < RayMap::kShards; ++shard) map.Add(shard, shards[shard]);
    }
    benchmark::DoNotOptimize(map.size());
  }
  Rate(state, rays.size());
}

struct HashOfCell {
  size_t operator()(CellKey cell) const { return MixBits(cell); }
};

struct Sums {
  std::array<uint32_t, 3> rgb = {};
  uint32_t count = 0;
};

template <class Map>
void InsertInto(benchmark::State& state, const auto& prepare) {
  const std::vector<BinnedRay> rays = RaysOfImages(static_cast<size_t>(state.range(0)));
  for (auto _ : state) {
    Map map;
    prepare(&map);
    for (const BinnedRay& ray : rays) {
      Sums& sums = map[ray.cell];
      for (int c = 0; c < 3; ++c) sums.rgb[c] += ray.rgb[c];
      ++sums.count;
    }
    benchmark::DoNotOptimize(map.size());
  }
  Rate(state, rays.size());
}
void InsertSparseHash(benchmark::State& state) {
  InsertInto<google::sparse_hash_map<CellKey, Sums, HashOfCell>>(state, [](auto*) {});
}
void InsertDenseHash(benchmark::State& state) {
  InsertInto<google::dense_hash_map<CellKey, Sums, HashOfCell>>(
      state, [](auto* map) { map->set_empty_key(0); });
}

constexpr int kWidth = 1920, kHeight = 1080;
constexpr int kStrip = 36;  // rows that the k-d tree computes; all rows would take a minute

// Rays spread over lens and plate, and a kernel that finds about 16 of them for each lens point.
struct FrameCase {
  std::vector<FrameRay> rays;
  QueryKernel kernel;
  LensPointSets points;
};
FrameCase CaseOf(size_t count) {
  constexpr double kRadius = 0.004, kHits = 16;
  FrameCase a;
  a.kernel.sigma_st_w = kRadius / 2;
  // hits = count * (volume of the reach) / (plate * the lens's square)
  const double volume = kPi * kPi / 2 * std::pow(kReach_sigmas, 4);
  const double per_sigma_uv2 = static_cast<double>(count) * volume / (kWidth * kHeight * 16.0);
  a.kernel.sigma_uv_px = std::sqrt(kHits / per_sigma_uv2);
  RandomSequence random(1);
  a.rays.resize(count);
  for (FrameRay& ray : a.rays) {
    ray.lens_x_w = static_cast<float>(random.Uniform(-kRadius, kRadius));
    ray.lens_y_w = static_cast<float>(random.Uniform(-kRadius, kRadius));
    ray.x_px = static_cast<float>(random.Uniform(0, kWidth));
    ray.y_px = static_cast<float>(random.Uniform(0, kHeight));
    const double grey = 30000 + 20000 * std::sin(ray.x_px / 3) * std::cos(ray.y_px / 4);
    for (int c = 0; c < 3; ++c) ray.rgb[c] = static_cast<float>(grey + random.Uniform(-5000, 5000));
  }
  // The rays are sorted row by row, like the cells of RayMap::Cells().
  std::sort(a.rays.begin(), a.rays.end(), [](const FrameRay& one, const FrameRay& other) {
    return std::pair(std::floor(one.y_px), one.x_px) <
           std::pair(std::floor(other.y_px), other.x_px);
  });
  a.points = MakeLensPoints({kRadius, 0, 0}, 16, 1, 0);
  return a;
}

void FrameBySplats(benchmark::State& state) {
  const FrameCase a = CaseOf(static_cast<size_t>(state.range(0)));
  ThreadPool pool(1);
  SplatFrame frame;
  for (auto _ : state) frame = Splat(a.rays, kWidth, kHeight, a.points, a.kernel, pool);
  // Largest and root mean square difference from the queries, in 1 / 255 of white.
  const SplatFrame judge = SplatReference(a.rays, kWidth, kStrip, a.points, a.kernel, pool);
  double worst = 0, sum2 = 0;
  for (int y = 0; y < kStrip - 4; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        const double difference = (frame.rgb.at(x, y, c) - judge.rgb.at(x, y, c)) * (255.0 / 65535);
        worst = std::max(worst, std::abs(difference));
        sum2 += difference * difference;
      }
  state.counters["rms"] = std::sqrt(sum2 / ((kStrip - 4.0) * kWidth * 3));
  state.counters["worst"] = worst;
  Rate(state, size_t{kWidth} * kHeight * 16);
}

void FrameByQueries(benchmark::State& state) {
  const FrameCase a = CaseOf(static_cast<size_t>(state.range(0)));
  ThreadPool pool(1);
  const RayQuery query(a.rays, a.kernel);
  double hits = 0;
  for (auto _ : state)
    for (int y = 0; y < kStrip; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (const Vec2& point : a.points.sets[0])
          hits += query.WithinReach(point, Vec2(x + 0.5, y + 0.5)).weight;
  benchmark::DoNotOptimize(hits);
  Rate(state, size_t{kWidth} * kStrip * 16);
}

void BuildTree(benchmark::State& state) {
  const FrameCase a = CaseOf(static_cast<size_t>(state.range(0)));
  for (auto _ : state) {
    const RayQuery query(a.rays, a.kernel);
    benchmark::DoNotOptimize(&query);
  }
  Rate(state, a.rays.size());
}

BENCHMARK(InsertOurs)->Arg(1000000)->Arg(4000000)->Unit(benchmark::kMillisecond);
BENCHMARK(InsertSparseHash)->Arg(1000000)->Arg(4000000)->Unit(benchmark::kMillisecond);
BENCHMARK(InsertDenseHash)->Arg(1000000)->Arg(4000000)->Unit(benchmark::kMillisecond);
BENCHMARK(FrameBySplats)->Arg(1000000)->Arg(4000000)->Unit(benchmark::kMillisecond);
BENCHMARK(FrameByQueries)->Arg(1000000)->Arg(4000000)->Unit(benchmark::kMillisecond);
BENCHMARK(BuildTree)->Arg(1000000)->Arg(4000000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lf

BENCHMARK_MAIN();
