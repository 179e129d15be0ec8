// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/wavelet53.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace lf {
namespace {

// Returns an array of `size` elements and slack.
template <class T>
std::vector<T> Array(size_t size) {
  return std::vector<T>(size + kSlack);
}

struct Analyzed {
  std::array<std::vector<int32_t>, kBands> bands;
};

Analyzed AnalyzedBy(Transform transform, const std::vector<int32_t>& values, int width,
                    int height) {
  Analyzed out;
  std::array<int32_t*, kBands> pointers{};
  for (int b = 0; b < kBands; ++b) {
    out.bands[b] = Array<int32_t>(BandSize(static_cast<Band>(b), width, height));
    pointers[b] = out.bands[b].data();
  }
  Analyze(transform, values.data(), width, height, pointers);
  for (int b = 0; b < kBands; ++b)
    out.bands[b].resize(BandSize(static_cast<Band>(b), width, height));
  return out;
}

template <class T>
std::vector<T> RandomPlane(std::mt19937& random, size_t size, int64_t low, int64_t high) {
  std::uniform_int_distribution<int64_t> value(low, high);
  std::vector<T> plane = Array<T>(size);
  for (T& v : plane) v = static_cast<T>(value(random));
  return plane;
}

struct PlaneSize {
  int width, height;
};

std::vector<PlaneSize> Sizes(std::mt19937& random) {
  std::vector<PlaneSize> sizes = {{1, 1}, {1, 2}, {2, 1}, {1, 7}, {7, 1}, {2, 2}, {3, 3}, {64, 64}};
  std::uniform_int_distribution<int> size(1, 150);
  for (int i = 0; i < 120; ++i) sizes.push_back({size(random), size(random)});
  return sizes;
}

TEST(Wavelet53, TheSynthesisGivesBackWhatWasAnalyzed) {
  std::mt19937 random(1);
  for (const auto& [width, height] : Sizes(random)) {
    const size_t size = static_cast<size_t>(width) * height;
    // Values beyond half of the range make sums overflow, but are restored exactly.
    const std::vector<int32_t> plane = RandomPlane<int32_t>(random, size, INT32_MIN, INT32_MAX);
    const Analyzed analyzed = AnalyzedBy(Transform::kSimd, plane, width, height);
    CodedBands<int32_t> bands{width, height, {}};
    std::array<std::vector<int32_t>, kBands> padded;
    for (int b = 0; b < kBands; ++b) {
      padded[b] = analyzed.bands[b];
      padded[b].resize(padded[b].size() + kSlack);
      bands.bands[b].values = padded[b].data();
    }
    std::vector<int32_t> back = Array<int32_t>(size);
    Synthesize(Transform::kSimd, bands, back.data());
    for (size_t i = 0; i < size; ++i)
      ASSERT_EQ(back[i], plane[i]) << width << "x" << height << " at " << i;
  }
}

TEST(Wavelet53, AnalysisIsThatOfTheReference) {
  std::mt19937 random(2);
  for (const auto& [width, height] : Sizes(random)) {
    const std::vector<int32_t> plane =
        RandomPlane<int32_t>(random, static_cast<size_t>(width) * height, -70000, 70000);
    const Analyzed a = AnalyzedBy(Transform::kReference, plane, width, height);
    const Analyzed b = AnalyzedBy(Transform::kSimd, plane, width, height);
    for (int band = 0; band < kBands; ++band)
      ASSERT_EQ(a.bands[band], b.bands[band]) << width << "x" << height << ", band " << band;
  }
}

template <class T, class Pixel>
void CompareSyntheses(std::mt19937& random, int64_t limit, int bits) {
  for (const auto& [width, height] : Sizes(random)) {
    CodedBands<T> bands{width, height, {}};
    std::array<std::vector<T>, kBands> values;
    for (int b = 0; b < kBands; ++b) {
      values[b] =
          RandomPlane<T>(random, BandSize(static_cast<Band>(b), width, height), -limit, limit);
      bands.bands[b] = {values[b].data(), static_cast<T>(1 + random() % 9), random() % 2 == 0};
    }
    const size_t size = static_cast<size_t>(width) * height;
    std::vector<T> a = Array<T>(size), b = Array<T>(size);
    Synthesize(Transform::kReference, bands, a.data());
    Synthesize(Transform::kSimd, bands, b.data());
    a.resize(size);
    b.resize(size);
    ASSERT_EQ(a, b) << width << "x" << height;

    const PixelScale scale{static_cast<int>(random() % 4), 1 << (bits - 1)};
    Image<Pixel> c(width, height), d(width, height);
    SynthesizePixels(Transform::kReference, bands, scale, c.view());
    SynthesizePixels(Transform::kSimd, bands, scale, d.view());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        ASSERT_EQ(c.at(x, y), d.at(x, y)) << width << "x" << height << " at " << x << ", " << y;
  }
}

TEST(Wavelet53, SynthesisIsThatOfTheReference) {
  std::mt19937 random(3);
  CompareSyntheses<int16_t, uint8_t>(random, 60, 8);
  CompareSyntheses<int32_t, uint8_t>(random, 60, 8);
  CompareSyntheses<int32_t, uint16_t>(random, 20000, 16);
}

TEST(Wavelet53, SynthesisIsThatOfTheReferenceBeyondTheRangeToo) {
  std::mt19937 random(4);
  CompareSyntheses<int16_t, uint8_t>(random, INT16_MAX, 8);
  CompareSyntheses<int32_t, uint16_t>(random, INT32_MAX, 16);
}

// A linear ramp has no high coefficients except at its end.
TEST(Wavelet53, RampsAreLowAlone) {
  std::vector<int32_t> plane = Array<int32_t>(16 * 3);
  for (int i = 0; i < 48; ++i) plane[i] = 10 * (i % 16);
  const Analyzed analyzed = AnalyzedBy(Transform::kSimd, plane, 16, 3);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 7; ++x) EXPECT_EQ(analyzed.bands[kHighLow][y * 8 + x], 0);
  EXPECT_EQ(analyzed.bands[kHighLow][7], 10);
  EXPECT_EQ(analyzed.bands[kLowLow][3], 60);
}

// The synthesis filters are (1/2, 1, 1/2) and (-1/8, -1/4, 3/4, -1/4, -1/8), so that the first two
// norms are sqrt(1.5) and sqrt(23 / 32). The others are those of two levels, filtered one after the
// other.
TEST(Wavelet53, NormsAreKnown) {
  EXPECT_NEAR(SynthesisNorm({false}), 1.2247, 1e-4);
  EXPECT_NEAR(SynthesisNorm({true}), 0.8478, 1e-4);
  EXPECT_NEAR(SynthesisNorm({false, false}), 1.6583, 1e-4);
  EXPECT_NEAR(SynthesisNorm({true, false}), 0.9601, 1e-4);
}

}  // namespace
}  // namespace lf
