// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/split_film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "lf/core/random.h"

namespace lf {
namespace {

std::vector<uint64_t> Sums(const std::vector<Section>& sections,
                           const std::vector<uint64_t>& costs) {
  std::vector<uint64_t> sums;
  size_t next = 0;
  for (const Section& section : sections) {
    EXPECT_EQ(section.begin, next);
    EXPECT_GT(section.end, section.begin);
    next = section.end;
    sums.push_back(std::accumulate(costs.begin() + static_cast<ptrdiff_t>(section.begin),
                                   costs.begin() + static_cast<ptrdiff_t>(section.end),
                                   uint64_t{0}));
  }
  EXPECT_EQ(next, costs.size());
  return sums;
}

TEST(SplitFilm, EqualFramesAreSharedOut) {
  const std::vector<uint64_t> costs(10, 7);
  for (const uint64_t sum : Sums(SplitByCost(costs, 4), costs)) {
    EXPECT_GE(sum, 14u);
    EXPECT_LE(sum, 21u);
  }
  EXPECT_EQ(SplitByCost(costs, 1), (std::vector<Section>{{0, 10}}));
  EXPECT_EQ(SplitByCost(costs, 25).size(), 10u);
  EXPECT_EQ(SplitByCost(std::vector<uint64_t>(3, 0), 3).size(), 3u);
  EXPECT_TRUE(SplitByCost({}, 3).empty());
}

// As in a film whose lens opens, the last frames cost a hundred times as much as the first.
TEST(SplitFilm, LongFilmsAreBalancedByCost) {
  std::vector<uint64_t> costs;
  for (uint64_t f = 0; f < 480; ++f) costs.push_back(1000 + f * f / 2 + RandomBits(1, 2, f) % 500);
  for (const size_t count : {2, 4, 7, 30}) {
    const std::vector<uint64_t> sums = Sums(SplitByCost(costs, count), costs);
    EXPECT_EQ(sums.size(), count);
    const uint64_t total = std::accumulate(sums.begin(), sums.end(), uint64_t{0});
    const uint64_t largest = *std::max_element(sums.begin(), sums.end());
    EXPECT_LT(static_cast<double>(largest * count) / static_cast<double>(total), 1.1) << count;
  }
}

TEST(SplitFilm, OneCostlyFrameIsAloneAndTheOthersAreShared) {
  std::vector<uint64_t> costs(20, 1);
  costs[3] = 1000;
  const auto sums = Sums(SplitByCost(costs, 4), costs);
  EXPECT_LE(sums.back(), 10u);
  EXPECT_GE(sums.back(), 6u);
}

TEST(SplitFilm, SectionsFit) {
  const std::vector<uint64_t> costs(100, 5);
  EXPECT_EQ(SplitToFit(costs, 25).size(), 4u);
  EXPECT_EQ(SplitToFit(costs, 1000).size(), 1u);
  for (const Section& section : SplitToFit(costs, 24)) EXPECT_LE(section.size(), 24u);
  std::vector<uint64_t> uneven(100, 1);
  uneven[50] = 10000;
  for (const Section& section : SplitToFit(uneven, 30)) EXPECT_LE(section.size(), 30u);
}

}  // namespace
}  // namespace lf
