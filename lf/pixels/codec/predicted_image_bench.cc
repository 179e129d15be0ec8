// SPDX-License-Identifier: Apache-2.0
// Measures how fast images of 1024 x 768 pixels are encoded and decoded relative to others, beside
// the same image encoded alone. The pictures show two planes (test_predictions.h). ns/pixel count
// pixels; "bytes" is the share of the bytes of the image encoded alone.
#include <benchmark/benchmark.h>

#include "lf/pixels/codec/predicted_image.h"
#include "lf/pixels/codec/test_predictions.h"

namespace lf {
namespace {

constexpr int kWidth = 1024, kHeight = 768;

struct BenchCase {
  PixelLayout layout;
  CodecSettings settings;
  DrawnGroup group;
};

// Arguments: layout, number of reference images, 1 if cameras are turned.
BenchCase CaseOf(const benchmark::State& state) {
  BenchCase found;
  found.layout = static_cast<PixelLayout>(state.range(0));
  found.group = MakeDrawnGroup<uint8_t>(static_cast<int>(state.range(1)), kWidth, kHeight,
                                        found.layout, found.settings);
  if (state.range(2) == 1)
    for (PlaneWarp& warp : found.group.warps) {
      // A turn by 0.5 degrees: squares of pixels move by different amounts.
      warp.far[0][1] += (1 << kWarpBits) / 115;
      warp.far[1][0] -= (1 << kWarpBits) / 115;
    }
  return found;
}

void ReportPixels(benchmark::State& state, size_t bytes, const BenchCase& of) {
  const size_t alone = EncodeImage(of.group.target, of.layout, of.settings).size();
  state.counters["bytes"] = static_cast<double>(bytes) / static_cast<double>(alone);
  state.counters["ns/pixel"] =
      benchmark::Counter(1e-9 * kWidth * kHeight * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void EncodeAlone(benchmark::State& state) {
  const BenchCase of = CaseOf(state);
  std::string code;
  for (auto _ : state) code = EncodeImage(of.group.target, of.layout, of.settings);
  ReportPixels(state, code.size(), of);
}

void EncodeFromOthers(benchmark::State& state) {
  const BenchCase of = CaseOf(state);
  const std::vector<Reference> references = of.group.references();
  std::string code;
  for (auto _ : state) code = EncodePredicted(of.group.target, of.layout, of.settings, references);
  ReportPixels(state, code.size(), of);
}

void DecodeAlone(benchmark::State& state) {
  const BenchCase of = CaseOf(state);
  const std::string code = EncodeImage(of.group.target, of.layout, of.settings);
  DecodedPart part;
  for (auto _ : state)
    if (!DecodeImage(code, &part)) state.SkipWithError("damage");
  ReportPixels(state, code.size(), of);
}

void DecodeFromOthers(benchmark::State& state) {
  const BenchCase of = CaseOf(state);
  const std::vector<const DecodedPart*> parts = of.group.parts();
  const std::string code =
      EncodePredicted(of.group.target, of.layout, of.settings, of.group.references());
  DecodedPart part;
  for (auto _ : state)
    if (!DecodePredicted(code, parts, {0, 0, kWidth, kHeight}, &part))
      state.SkipWithError("damage");
  ReportPixels(state, code.size(), of);
}

void Alone(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"layout", "references", "turned"});
  for (const int layout : {0, 1, 2}) benchmark->Args({layout, 1, 0});
}
void FromOthers(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"layout", "references", "turned"});
  for (const int layout : {0, 1, 2})
    for (const int references : {1, 3, 4}) benchmark->Args({layout, references, 0});
  for (const int layout : {0, 1, 2}) benchmark->Args({layout, 3, 1});
}
BENCHMARK(EncodeAlone)->Apply(Alone)->Unit(benchmark::kMillisecond);
BENCHMARK(EncodeFromOthers)->Apply(FromOthers)->Unit(benchmark::kMillisecond);
BENCHMARK(DecodeAlone)->Apply(Alone)->Unit(benchmark::kMillisecond);
BENCHMARK(DecodeFromOthers)->Apply(FromOthers)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lf
