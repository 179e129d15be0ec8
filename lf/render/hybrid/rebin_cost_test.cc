// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/rebin_cost.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "lf/rebinning/frame_rays.h"
#include "lf/rebinning/ray_map.h"

namespace lf {
namespace {

// A tenth of the LF images of one section: 1000 of 10,000 LF pixels, in 400 of 4000 cells.
RebinSample Tenth() {
  RebinSample sample;
  sample.pixel_count = 1000;
  sample.cell_count = 400;
  sample.rebin_s = 0.5;
  sample.find_s = 0.01;
  sample.sort_s = 0.25;
  sample.empty_s = 0.125;
  sample.complete_s = 0.375;
  return sample;
}

TEST(RebinCost, StagesGrowWithPixelsImagesCellsAndFrames) {
  const std::array<RebinSection, 1> section = {RebinSection{3, 10000}};
  const std::array<size_t, 1> expected = {4000};
  const RebinCost cost = CostOf(Tenth(), section, 20, 100000, expected);
  EXPECT_EQ(cost.pixel_count, 10000u);
  EXPECT_EQ(cost.cell_count, 4000u);
  EXPECT_DOUBLE_EQ(cost.rebin_s, 0.5 * 10 + 3 * 0.01 * 20);
  EXPECT_DOUBLE_EQ(cost.complete_s, 0.25 * 10 + 3 * (0.125 + (0.375 - 0.125) * 10));
  EXPECT_DOUBLE_EQ(cost.begin_s, 0);
}

TEST(RebinCost, SectionsAreAddedAndNoneHasMoreCellsThanFit) {
  const std::array<RebinSection, 2> sections = {RebinSection{1, 10000}, RebinSection{2, 5000}};
  const std::array<size_t, 2> expected = {4000, 2000};
  const RebinCost cost = CostOf(Tenth(), sections, 0, 3000, expected);
  EXPECT_EQ(cost.pixel_count, 15000u);
  EXPECT_EQ(cost.cell_count, 3000u + 2000u);
  EXPECT_DOUBLE_EQ(cost.rebin_s, 0.5 * 15);
  EXPECT_DOUBLE_EQ(cost.complete_s,
                   0.25 * (7.5 + 5) + (0.125 + 0.25 * 7.5) + 2 * (0.125 + 0.25 * 5));
}

TEST(RebinCost, MemoryIsThatOfTheMapsAndOfTheRaysOfOneFrame) {
  const std::array<RebinSection, 1> section = {RebinSection{3, 1e6}};
  const std::array<size_t, 1> expected = {400000};
  const RebinCost cost = CostOf(Tenth(), section, 20, 1000000, expected);
  ASSERT_EQ(cost.cell_count, 400000u);
  RayMap map(1000000, 400000);
  EXPECT_EQ(RayMap::BytesFor(1000000, 400000, 400000), map.size_bytes());
  EXPECT_EQ(cost.map_bytes, map.size_bytes());
  EXPECT_EQ(cost.frame_bytes,
            400000 * (sizeof(BinnedCell) + sizeof(FrameRay) + 2 * sizeof(uint32_t)));
}

TEST(RebinCost, AMapThatGrowsTakesTheMemoryThatItIsExpectedToTake) {
  ThreadPool pool(2);
  RayMap map(1000000, 1000);
  size_t count = 0;
  std::vector<BinnedRay> rays(1);
  for (uint64_t cell = 1; cell <= 200000; ++cell, ++count) {
    rays[0].cell = cell;
    map.Add(RayMap::ShardOf(cell), rays);
  }
  ASSERT_EQ(map.size(), count);
  const double bytes = static_cast<double>(RayMap::BytesFor(1000000, 1000, count));
  EXPECT_NEAR(static_cast<double>(map.size_bytes()) / bytes, 1, 0.05);
}

TEST(RebinCost, WithoutASampleNothingIsKnownOfTimes) {
  const std::array<RebinSection, 1> section = {RebinSection{3, 10000}};
  const std::array<size_t, 1> expected = {4000};
  const RebinCost cost = CostOf({}, section, 20, 100000, expected);
  EXPECT_EQ(cost.rebin_s + cost.complete_s, 0);
  EXPECT_EQ(cost.pixel_count, 10000u);
}

}  // namespace
}  // namespace lf
