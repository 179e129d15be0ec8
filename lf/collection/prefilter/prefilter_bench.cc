// SPDX-License-Identifier: Apache-2.0
// Measures how long FilterPixels() takes, in ns per pixel, for elements of several widths, without
// and with the correction of mosaics, and with every instruction set of the processor.
#include <benchmark/benchmark.h>
#include <hwy/highway.h>

#include <cstdint>
#include <string>

#include "lf/collection/prefilter/prefilter.h"

namespace lf {
namespace {

// The arguments are four times the width of an element in LF pixels, and the strength of the
// correction.
void BM_FilterPixels(benchmark::State& state, int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().DeInit();
  const PixelRect rect{0, 0, 960, 640};
  LfPixels pixels(rect, BayerPattern::kNone), filtered;
  pixels.recorded = BayerPattern::kRggb;
  Prefilter filter = PrefilterFor(static_cast<double>(state.range(0)) / 4, PixelFootprint::kArea);
  filter.correction = static_cast<int>(state.range(1));
  for (auto _ : state) {
    FilterPixels(filter, pixels, &filtered);
    benchmark::DoNotOptimize(filtered.radiance.row(0));
  }
  state.counters["ns_per_pixel"] = benchmark::Counter(
      1e-9 * static_cast<double>(rect.pixel_count()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

[[maybe_unused]] const bool registered = [] {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    benchmark::RegisterBenchmark(
        (std::string("BM_FilterPixels/") + hwy::TargetName(target)).c_str(), BM_FilterPixels,
        target)
        ->ArgsProduct({{4, 8, 13, 16, 32, 64}, {0}})
        ->Args({4, 3});
  return true;
}();

}  // namespace
}  // namespace lf
