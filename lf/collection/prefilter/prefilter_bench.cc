// SPDX-License-Identifier: Apache-2.0
// Measures how long FilterPixels() takes, in ns per pixel, for elements of several widths.
#include <benchmark/benchmark.h>

#include "lf/collection/prefilter/prefilter.h"

namespace lf {
namespace {

// The argument is four times the width of an element in LF pixels.
void BM_FilterPixels(benchmark::State& state) {
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
}
BENCHMARK(BM_FilterPixels)->Arg(4)->Arg(8)->Arg(16)->Arg(32)->Arg(64);

}  // namespace
}  // namespace lf
