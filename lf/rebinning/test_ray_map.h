// SPDX-License-Identifier: Apache-2.0
// Random rays for ray maps of tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/core/random.h"
#include "lf/rebinning/ray_map.h"

namespace lf {

inline std::vector<BinnedRay> RandomRays(size_t count, uint64_t cells, uint64_t seed) {
  std::vector<BinnedRay> rays(count);
  for (size_t i = 0; i < count; ++i) {
    rays[i].cell = 1 + RandomBits(seed, 0, i) % cells;
    for (size_t c = 0; c < 3; ++c)
      rays[i].rgb[c] = static_cast<uint16_t>(RandomBits(seed, 1 + c, i));
  }
  return rays;
}

inline void AddAll(const std::vector<BinnedRay>& rays, RayMap* map) {
  std::vector<std::vector<BinnedRay>> by_shard(RayMap::kShards);
  for (const BinnedRay& ray : rays) by_shard[RayMap::ShardOf(ray.cell)].push_back(ray);
  for (size_t shard = 0; shard < RayMap::kShards; ++shard) map->Add(shard, by_shard[shard]);
}

}  // namespace lf
