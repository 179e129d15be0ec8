// SPDX-License-Identifier: Apache-2.0
// Measures how long FilterPixels() takes, in ns per pixel, for elements of several widths and with
// every instruction set of the processor.
#include <benchmark/benchmark.h>
#include <hwy/highway.h>

#include <cstdint>
#include <string>

#include "lf/collection/prefilter/prefilter.h"

namespace lf {
namespace {

// The argument is four times the width of an element in LF pixels.
void BM_FilterPixels(benchmark::State& state, int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().DeInit();
  const PixelRect rect{0, 0, 960, 640};
  LfPixels pixels(rect, BayerPattern::kNone), filtered;
  const Prefilter filter =
      PrefilterFor(static_cast<double>(state.range(0)) / 4, PixelFootprint::kArea);
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
        ->Arg(4)
        ->Arg(8)
        ->Arg(13)
        ->Arg(16)
        ->Arg(32)
        ->Arg(64);
  return true;
}();

}  // namespace
}  // namespace lf
