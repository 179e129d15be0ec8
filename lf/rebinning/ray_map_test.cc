// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/ray_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "lf/rebinning/test_ray_map.h"

namespace lf {
namespace {

std::map<CellKey, BinnedCell> CellsOf(const RayMap& map) {
  ThreadPool pool(2);
  std::map<CellKey, BinnedCell> cells;
  CellKey last = 0;
  for (const BinnedCell& cell : map.Cells(pool)) {
    EXPECT_GT(cell.cell, last);
    last = cell.cell;
    cells.emplace(cell.cell, cell);
  }
  EXPECT_EQ(cells.size(), map.size());
  return cells;
}

TEST(RayMap, HoldsTheSumsOfItsRays) {
  const std::vector<BinnedRay> rays = RandomRays(100000, 30000, 1);
  RayMap map(1 << 20);
  AddAll(rays, &map);
  std::map<CellKey, BinnedCell> expected;
  for (const BinnedRay& ray : rays) {
    expected[ray.cell].cell = ray.cell;
    expected[ray.cell].Add(ray);
  }
  EXPECT_EQ(CellsOf(map), expected);
  EXPECT_EQ(map.size(), expected.size());
  const BinnedCell& cell = expected.begin()->second;
  EXPECT_GE(cell.count, 1u);
  EXPECT_LE(cell.Mean(2), 65535);
}

TEST(RayMap, WhatIsKeptDependsOnTheRaysAlone) {
  std::vector<BinnedRay> rays = RandomRays(60000, 1 << 30, 2);
  ThreadPool one(1), three(3);
  std::map<CellKey, BinnedCell> first;
  for (int round = 0; round < 4; ++round) {
    // Batches, order and number of threads differ from round to round.
    const size_t batch = round == 0 ? rays.size() : 1000 + 777 * round;
    std::sort(rays.begin(), rays.end(), [round](const BinnedRay& a, const BinnedRay& b) {
      return MixBits(a.cell + round) < MixBits(b.cell + round);
    });
    RayMap map(5000);
    for (size_t begin = 0; begin < rays.size(); begin += batch) {
      AddAll({rays.begin() + begin, rays.begin() + std::min(begin + batch, rays.size())}, &map);
      map.Trim(round % 2 == 0 ? one : three);
      EXPECT_LE(map.size(), 5000u);
    }
    EXPECT_GT(map.size(), 4200u);  // Trim() drops about an eighth at a time
    if (round == 0) first = CellsOf(map);
    EXPECT_EQ(CellsOf(map), first);
    for (const auto& [key, cell] : first) EXPECT_TRUE(map.MayHold(key));
  }
}

TEST(RayMap, CellsThatOverflowAreTold) {
  const std::vector<BinnedRay> rays(BinnedCell::kMostRays, {7, {65535, 65535, 0}});
  RayMap map(10);
  AddAll(rays, &map);
  EXPECT_FALSE(map.is_too_coarse());
  EXPECT_EQ(CellsOf(map)[7].Mean(1), 65535);
  AddAll({rays[0]}, &map);
  EXPECT_TRUE(map.is_too_coarse());
}

TEST(RayMap, RaysMayBeAddedWithoutNewCells) {
  const std::vector<BinnedRay> rays = RandomRays(2000, 500, 3);
  const std::vector<BinnedRay> more = RandomRays(2000, 1000, 4);
  RayMap map(1 << 20);
  AddAll(rays, &map);
  const size_t size = map.size();
  std::map<CellKey, BinnedCell> expected = CellsOf(map);
  for (const BinnedRay& ray : more) {
    map.AddToThoseThere(RayMap::ShardOf(ray.cell), std::span(&ray, 1));
    const auto found = expected.find(ray.cell);
    if (found != expected.end()) found->second.Add(ray);
  }
  EXPECT_EQ(map.size(), size);
  EXPECT_EQ(CellsOf(map), expected);
}

// The map grows from a small expected size, even if it gets more than max_cells before Trim().
TEST(RayMap, GrowsToWhatItsCellsNeed) {
  ThreadPool pool(2);
  RayMap map(20000, 100);
  EXPECT_LT(map.size_bytes(), 400 * sizeof(BinnedCell) * RayMap::kShards);
  size_t most = 0;
  for (int i = 0; i < 20; ++i) {
    AddAll(RandomRays(10000, UINT64_MAX, 5 + i), &map);
    most = std::max(most, map.size_bytes());
    map.Trim(pool);
  }
  EXPECT_GT(map.size(), 15000u);
  EXPECT_LE(most, 2 * 20000 * sizeof(BinnedCell) + (64u << 10) * sizeof(BinnedCell) / 8);
}

}  // namespace
}  // namespace lf
