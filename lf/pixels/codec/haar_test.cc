// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/haar.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace lf {
namespace {

using BandValues = std::array<std::vector<int32_t>, kBands>;

BandValues HaarBands(const std::vector<int32_t>& values, int width, int height) {
  BandValues bands;
  std::array<int32_t*, kBands> pointers{};
  for (int b = 0; b < kBands; ++b) {
    bands[b].resize(BandSize(static_cast<Band>(b), width, height));
    pointers[b] = bands[b].data();
  }
  AnalyzeHaar(values.data(), width, height, pointers);
  return bands;
}

// Equations 2.20 and 2.21 applied to 10 12 / 14 20: rows give averages 11 and 17, differences -1
// and -3.
TEST(Haar, IsThatOfTheThesis) {
  constexpr int32_t kOne = 1 << kHaarBits;
  const BandValues bands = HaarBands({10 * kOne, 12 * kOne, 14 * kOne, 20 * kOne}, 2, 2);
  EXPECT_EQ(bands[kLowLow], std::vector<int32_t>{14 * kOne});
  EXPECT_EQ(bands[kHighLow], std::vector<int32_t>{-2 * kOne});
  EXPECT_EQ(bands[kLowHigh], std::vector<int32_t>{-3 * kOne});
  EXPECT_EQ(bands[kHighHigh], std::vector<int32_t>{1 * kOne});
}

TEST(Haar, TheLastOfAnOddNumberIsItsOwnAverage) {
  constexpr int32_t kOne = 1 << kHaarBits;
  const BandValues bands = HaarBands({1 * kOne, 3 * kOne, 7 * kOne}, 3, 1);
  EXPECT_EQ(bands[kLowLow], (std::vector<int32_t>{2 * kOne, 7 * kOne}));
  EXPECT_EQ(bands[kHighLow], std::vector<int32_t>{-1 * kOne});
  EXPECT_TRUE(bands[kLowHigh].empty());
}

TEST(Haar, FiveLevelsOfSixteenBitsComeBackByBothTransforms) {
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    const int width = static_cast<int>(1 + random() % 90),
              height = static_cast<int>(1 + random() % 90);
    std::vector<int32_t> plane(static_cast<size_t>(width) * height);
    for (int32_t& v : plane) v = static_cast<int32_t>(random() % 65536) << kHaarBits;
    std::vector<BandValues> levels;
    std::vector<std::pair<int, int>> sizes;
    std::vector<int32_t> low = plane;
    for (int level = 0, w = width, h = height; level < 5; ++level) {
      levels.push_back(HaarBands(low, w, h));
      sizes.emplace_back(w, h);
      low = levels.back()[kLowLow];
      w = LowCount(w);
      h = LowCount(h);
    }
    for (const Transform transform : {Transform::kReference, Transform::kSimd}) {
      std::vector<int32_t> back = low;
      for (int level = 4; level >= 0; --level) {
        const auto [w, h] = sizes[level];
        const BandValues& bands = levels[level];
        std::vector<int32_t> finer(static_cast<size_t>(w) * h);
        SynthesizeHaar(
            transform,
            {back.data(), bands[kHighLow].data(), bands[kLowHigh].data(), bands[kHighHigh].data()},
            w, h, finer.data());
        back = finer;
      }
      ASSERT_EQ(back, plane) << width << "x" << height;
    }
  }
}

}  // namespace
}  // namespace lf
