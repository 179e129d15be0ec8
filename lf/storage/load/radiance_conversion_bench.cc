// SPDX-License-Identifier: Apache-2.0
// Measures how long ConvertRadiance() takes for an 8-bit RGB image, in ns per pixel, with and
// without a falloff.
#include <benchmark/benchmark.h>

#include "lf/storage/load/radiance_conversion.h"

namespace lf {
namespace {

// The argument is 1 if the camera has a falloff, otherwise 0.
void BM_ConvertBytes(benchmark::State& state) {
  constexpr int kWidth = 960, kHeight = 640;
  Intrinsics k;
  k.width_px = kWidth;
  k.height_px = kHeight;
  k.cx_px = kWidth / 2.;
  k.cy_px = kHeight / 2.;
  if (state.range(0) == 1) k.vignetting.v = {-0.3, 0.05, -0.15};
  Image<uint8_t> image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int i = 0; i < 3 * kWidth; ++i) image.row(y)[i] = static_cast<uint8_t>(i * 7 + y);
  ImagePart part;
  part.rect = {0, 0, kWidth, kHeight};
  part.image = std::move(image);
  const RadianceEncoding encoding;
  const RadianceTables plain(encoding, ChannelGains());
  LfPixels pixels(part.rect, BayerPattern::kNone);
  for (auto _ : state) {
    ConvertRadiance(part, 3, plain, encoding, LfCamera(), k, &pixels);
    benchmark::DoNotOptimize(pixels.radiance.row(0));
  }
  state.counters["ns_per_pixel"] =
      benchmark::Counter(1e-9 * kWidth * kHeight, benchmark::Counter::kIsIterationInvariantRate |
                                                      benchmark::Counter::kInvert);
}
BENCHMARK(BM_ConvertBytes)->Arg(0)->Arg(1);

}  // namespace
}  // namespace lf
