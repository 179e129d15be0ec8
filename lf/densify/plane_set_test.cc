// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/plane_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace lf {
namespace {

TEST(PlaneSet, RunsAreApartInMemoryAndShortGapsAreFilled) {
  const std::vector<uint8_t> marks = {0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 0};
  const PlaneSet set = PlaneSet::Marked(marks);
  ASSERT_EQ(set.runs().size(), 2U);
  EXPECT_EQ(set.runs()[0].first, 1);
  EXPECT_EQ(set.runs()[0].count, 5);
  EXPECT_EQ(set.runs()[0].entry, 0);
  EXPECT_EQ(set.runs()[1].first, 9);
  EXPECT_EQ(set.runs()[1].count, 1);
  EXPECT_EQ(set.runs()[1].entry, 7);
  EXPECT_EQ(set.entries(), 8);
  EXPECT_EQ(&set.RunAt(4), &set.runs()[0]);
  EXPECT_EQ(&set.RunAt(7), &set.runs()[1]);
}

TEST(PlaneSet, EntriesThatAreNoPlanesHaveNoDepth) {
  const std::vector<float> depths =
      PlaneSet::Marked(std::vector<uint8_t>{1, 0, 0, 0, 1}).Depths({1, 3}, 5);
  ASSERT_EQ(depths.size(), 4U);
  EXPECT_EQ(depths[0], 1.0f);
  EXPECT_TRUE(std::isnan(depths[1]));
  EXPECT_TRUE(std::isnan(depths[2]));
  EXPECT_EQ(depths[3], 3.0f);
}

TEST(PlaneSet, AllPlanesAreOneRun) {
  const PlaneSet all = PlaneSet::All(7);
  EXPECT_EQ(all.entries(), 7);
  EXPECT_TRUE(all == PlaneSet::Marked(std::vector<uint8_t>(7, 1)));
  EXPECT_FALSE(all == PlaneSet::All(8));
}

}  // namespace
}  // namespace lf
