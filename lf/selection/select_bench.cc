// SPDX-License-Identifier: Apache-2.0
// Measures selection in the band of the thesis (5.1): the LF cameras are on half a circle around
// the scene, at about the same height, and look at its middle.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "lf/core/random.h"
#include "lf/selection/overlap.h"
#include "lf/selection/select.h"

namespace lf {
namespace {

constexpr double kRadius_w = 1;
constexpr double kHeight_w = 0.01;

LightField Band(size_t count) {
  LightField field;
  field.intrinsics = {{2100, 2100, 1024, 1024, 0, 2048, 2048, {}}};
  for (uint64_t i = 0; i < count; ++i) {
    const double angle = kPi * RandomUnit(1, i, 0);
    const Vec3 centre(kRadius_w * std::cos(angle), kHeight_w * (RandomUnit(1, i, 1) - 0.5),
                      -kRadius_w * std::sin(angle));
    field.cameras.push_back({*LookAlong(centre, -centre, -Vec3::UnitY()), 0, 1});
  }
  return field;
}

// Returns a path along a tenth of the band.
std::vector<RenderCamera> Path(size_t count, double aperture_diameter_w) {
  std::vector<RenderCamera> frames;
  for (size_t f = 0; f < count; ++f) {
    const double angle = kPi * (0.45 + 0.1 * static_cast<double>(f) / static_cast<double>(count));
    const Vec3 centre(kRadius_w * std::cos(angle), 0, -kRadius_w * std::sin(angle));
    RenderCamera frame;
    frame.pinhole.intrinsics = {2000, 2000, 960, 540, 0, 1920, 1080, {}};
    frame.pinhole.cam_from_world = *LookAlong(centre, -centre, -Vec3::UnitY());
    frame.aperture.radius_w = 0.5 * aperture_diameter_w;
    frame.focus_plane = FocusPlane(frame.pinhole, kRadius_w, {});
    frames.push_back(frame);
  }
  return frames;
}

void BuildIndex(benchmark::State& state) {
  const LightField field = Band(static_cast<size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(ImageIndex(field));
}
BENCHMARK(BuildIndex)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

// Arguments: number of LF cameras, number of frames, diameter of the aperture in thousandths of a
// world unit.
void Select(benchmark::State& state) {
  const LightField field = Band(static_cast<size_t>(state.range(0)));
  const ImageIndex index(field);
  const std::vector<RenderCamera> frames =
      Path(static_cast<size_t>(state.range(1)), 1e-3 * static_cast<double>(state.range(2)));
  ThreadPool pool(1);
  double pairs = 0;
  for (auto _ : state) {
    pairs = 0;
    for (const SelectedImage& image : SelectImages(index, frames, {}, pool))
      pairs += image.frame_count;
  }
  const double all_pairs = static_cast<double>(field.size()) * static_cast<double>(frames.size());
  state.counters["share"] = pairs / all_pairs;
  state.counters["s/frame"] =
      benchmark::Counter(static_cast<double>(frames.size() * state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(Select)
    ->Args({10'000, 30, 30})
    ->Args({100'000, 30, 30})
    ->Args({1'000'000, 30, 30})
    ->Args({1'000'000, 30, 150})
    ->Args({1'000'000, 480, 30})
    ->Args({1'000'000, 900, 30})
    ->Unit(benchmark::kMillisecond);

// Selects without an octree: tests every LF camera for each frame. If kQuickly is true, an
// ImageOverlap is made once for all frames; otherwise once for each frame.
template <bool kQuickly>
void AskEveryCamera(benchmark::State& state) {
  const LightField field = Band(static_cast<size_t>(state.range(0)));
  const std::vector<RenderCamera> frames =
      Path(static_cast<size_t>(state.range(1)), 1e-3 * static_cast<double>(state.range(2)));
  size_t pairs = 0;
  for (auto _ : state)
    for (uint32_t i = 0; i < field.size(); ++i) {
      if constexpr (kQuickly) {
        const ImageOverlap overlap(field.Camera({i}), {}, PixelReach::kOwn);
        for (const RenderCamera& frame : frames) pairs += overlap.Rect(frame).empty() ? 0 : 1;
      } else {
        for (const RenderCamera& frame : frames)
          pairs += ContributingRect(field.Camera({i}), frame).empty() ? 0 : 1;
      }
    }
  benchmark::DoNotOptimize(pairs);
  state.counters["s/frame"] =
      benchmark::Counter(static_cast<double>(frames.size() * state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(AskEveryCamera<false>)
    ->Args({10'000, 30, 30})
    ->Args({1'000'000, 3, 30})
    ->Args({1'000'000, 3, 150})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(AskEveryCamera<true>)
    ->Args({10'000, 30, 30})
    ->Args({1'000'000, 3, 30})
    ->Args({1'000'000, 3, 150})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lf
