// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/lens_ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

std::vector<uint16_t> Noise(size_t count, uint64_t seed) {
  std::vector<uint16_t> values;
  for (size_t i = 0; i < count; ++i)
    values.push_back(static_cast<uint16_t>(RandomBits(seed, 0, i) % 50 * 1310));
  return values;
}

TEST(LensRanks, TheMedianOfAnEvenNumberIsTheMeanOfTheTwoInTheMiddle) {
  EXPECT_EQ(RanksOf(LensStatistic::kMedian, 0, 1), (ValueRange{0, 1}));
  EXPECT_EQ(RanksOf(LensStatistic::kMedian, 0, 2), (ValueRange{0, 2}));
  EXPECT_EQ(RanksOf(LensStatistic::kMedian, 0, 5), (ValueRange{2, 3}));
  EXPECT_EQ(RanksOf(LensStatistic::kMedian, 0, 6), (ValueRange{2, 4}));
}

TEST(LensRanks, AShareIsCutAtEachEndAndRoundedDown) {
  EXPECT_EQ(RanksOf(LensStatistic::kTrimmed, 0.25, 8), (ValueRange{2, 6}));
  EXPECT_EQ(RanksOf(LensStatistic::kTrimmed, 0.25, 7), (ValueRange{1, 6}));
  EXPECT_EQ(RanksOf(LensStatistic::kTrimmed, 0.29, 100), (ValueRange{29, 71}));
  EXPECT_EQ(RanksOf(LensStatistic::kTrimmed, 0, 9), (ValueRange{0, 9}));
  for (size_t count = 1; count < 40; ++count) {
    const ValueRange ranks = RanksOf(LensStatistic::kTrimmed, 0.4999999999, count);
    EXPECT_LT(ranks.begin, ranks.end) << count;
    EXPECT_EQ(ranks.begin, count - ranks.end);
  }
}

TEST(LensRanks, SumsAreThoseOfSortedValuesInAnyOrder) {
  for (const size_t count : {1, 2, 3, 10, 37}) {
    std::vector<uint16_t> values = Noise(count, count), sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (const LensStatistic statistic :
         {LensStatistic::kMin, LensStatistic::kMax, LensStatistic::kMedian, LensStatistic::kTrimmed,
          LensStatistic::kMean}) {
      const ValueRange ranks = RanksOf(statistic, 0.2, count);
      uint64_t sum = 0;
      for (size_t i = ranks.begin; i < ranks.end; ++i) sum += sorted[i];
      for (int turn = 0; turn < 3; ++turn) {
        std::rotate(values.begin(), values.begin() + static_cast<ptrdiff_t>(count / 3),
                    values.end());
        std::vector<uint16_t> given = values;
        EXPECT_EQ(SumOfRanks(given, ranks), (ElementSum{sum, ranks.end - ranks.begin}));
      }
    }
  }
}

TEST(LensRanks, RaysInOrderOfLuminanceKeepTheirColours) {
  std::vector<RankedRay> rays = {{60000, 0, 0, 1}, {0, 60000, 0, 2}, {0, 0, 60000, 3}};
  PutRanksInPlace(rays, {1, 2});  // blue is the darkest, and green the brightest
  EXPECT_EQ(rays[1].red(), 60000);
  EXPECT_EQ(rays[1].green(), 0);
  EXPECT_EQ(rays[1].blue, 0);
  EXPECT_EQ(rays[1].opacity, 1);
}

TEST(LensRanks, EqualRaysAreInterchangeable) {
  // Equal luminance, other colours: 2126 * 722 = 722 * 2126.
  std::vector<RankedRay> one = {{722, 5, 0, 0}, {0, 5, 2126, 0}, {722, 5, 0, 9}};
  std::vector<RankedRay> other = {one[2], one[1], one[0]};
  PutRanksInPlace(one, {1, 2});
  PutRanksInPlace(other, {1, 2});
  EXPECT_EQ(one[1], other[1]);
}

}  // namespace
}  // namespace lf
