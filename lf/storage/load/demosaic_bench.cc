// SPDX-License-Identifier: Apache-2.0
// Measures how long Demosaic() takes for a mosaic of 960 x 640 pixels, in ns per pixel, on each
// instruction set of the machine.
#include <benchmark/benchmark.h>
#include <hwy/highway.h>

#include "lf/core/random.h"
#include "lf/storage/load/demosaic.h"

namespace lf {
namespace {

void MeasureDemosaic(benchmark::State& state, int64_t target) {
  constexpr int kWidth = 960, kHeight = 640;
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().DeInit();
  LfPixels mosaic({0, 0, kWidth, kHeight}, BayerPattern::kRggb);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      mosaic.radiance.at(x, y) =
          static_cast<uint16_t>(4096 + 30 * x + 20 * y + RandomBits(1, x, y) % 500);
  RadianceEncoding encoding;
  encoding.pedestal = 4096;
  encoding.white_balance = {2, 1, 1.5};
  LfPixels rgb;
  for (auto _ : state) {
    Demosaic(mosaic, kWidth, kHeight, encoding, mosaic.rect, &rgb);
    benchmark::DoNotOptimize(rgb.radiance.row(0));
  }
  state.counters["ns_per_pixel"] =
      benchmark::Counter(1e-9 * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate |
                                                      benchmark::Counter::kInvert);
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

const bool kRegistered = [] {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    benchmark::RegisterBenchmark((std::string("Demosaic/") + hwy::TargetName(target)).c_str(),
                                 MeasureDemosaic, target);
  return true;
}();

}  // namespace
}  // namespace lf
