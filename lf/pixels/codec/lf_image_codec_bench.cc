// SPDX-License-Identifier: Apache-2.0
// Measures how fast 2048x2048 mosaics and 1920x1280 RGB images, both of 8 bits, are encoded and
// decoded. MB/s count the bytes of the unencoded pixels. The mosaic is read from the file
// LF_BENCH_IMAGE (raw bytes of 2048x2048 pixels) if this environment variable is set; otherwise,
// and for RGB, the picture consists of waves of several lengths with noise of 1.5 grey values.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "lf/pixels/codec/lf_image_codec.h"

namespace lf {
namespace {

Image<uint8_t> Drawn(int width, int height, int channels) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1.5);
  Image<uint8_t> image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) {
        double v = 120 + noise(random) + 20 * ((x & 1) - (y & 1));
        for (int wave = 512, k = 1; wave >= 8; wave /= 2, ++k)
          v += 40.0 * std::sqrt(wave / 512.0) * std::sin(6.28 * x / wave + k) *
               std::cos(6.28 * y / wave + c + k);
        image.at(x, y, c) = static_cast<uint8_t>(std::clamp(v, 0.0, 255.0));
      }
  return image;
}

const CodecPixels& Mosaic() {
  static const CodecPixels pixels = [] {
    Image<uint8_t> image;
    const char* const path = std::getenv("LF_BENCH_IMAGE");
    if (path == nullptr) image = Drawn(2048, 2048, 1);
    if (path != nullptr) {
      image.Resize(2048, 2048, 1);
      std::ifstream(path, std::ios::binary)
          .read(reinterpret_cast<char*>(image.pixels().data()),
                static_cast<std::streamsize>(image.size_bytes()));
    }
    return CodecPixels(std::move(image));
  }();
  return pixels;
}

const CodecPixels& Rgb() {
  static const CodecPixels pixels = Drawn(1920, 1280, 3);
  return pixels;
}

CodecSettings SettingsOf(int64_t profile) {
  CodecSettings settings;
  settings.profile = static_cast<CodecProfile>(profile);
  if (settings.profile == CodecProfile::kThesis) settings = {settings.profile, 1, 8, 256};
  return settings;
}

void Report(benchmark::State& state, size_t bytes, size_t code_bytes) {
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(bytes));
  state.counters["ratio"] = static_cast<double>(bytes) / static_cast<double>(code_bytes);
}

size_t BytesOf(const CodecPixels& pixels) {
  return std::visit([](const auto& image) { return image.size_bytes(); }, pixels);
}

void Encode(benchmark::State& state, const CodecPixels& pixels, PixelLayout layout) {
  std::string code;
  for (auto _ : state) {
    code = EncodeImage(pixels, layout, SettingsOf(state.range(0)));
    benchmark::DoNotOptimize(code.data());
  }
  Report(state, BytesOf(pixels), code.size());
}

void Decode(benchmark::State& state, const CodecPixels& pixels, PixelLayout layout) {
  const std::string code = EncodeImage(pixels, layout, SettingsOf(state.range(0)));
  DecodedPart part;
  for (auto _ : state) {
    if (!DecodeImage(code, &part)) state.SkipWithError("damage");
    benchmark::DoNotOptimize(&part);
  }
  Report(state, BytesOf(pixels), code.size());
}

void EncodeMosaic(benchmark::State& state) { Encode(state, Mosaic(), PixelLayout::kMosaic); }
void DecodeMosaic(benchmark::State& state) { Decode(state, Mosaic(), PixelLayout::kMosaic); }
void EncodeRgb(benchmark::State& state) { Encode(state, Rgb(), PixelLayout::kRgb); }
void DecodeRgb(benchmark::State& state) { Decode(state, Rgb(), PixelLayout::kRgb); }

// Profiles: 0 thesis, 1 default, 2 lossless.
BENCHMARK(EncodeMosaic)->DenseRange(0, 2)->ArgName("profile");
BENCHMARK(DecodeMosaic)->DenseRange(0, 2)->ArgName("profile");
BENCHMARK(EncodeRgb)->DenseRange(0, 2)->ArgName("profile");
BENCHMARK(DecodeRgb)->DenseRange(0, 2)->ArgName("profile");

}  // namespace
}  // namespace lf
