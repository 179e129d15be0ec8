// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_depths.h"

#include <algorithm>
#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr uint64_t kSeed = 0;
constexpr double kShareOutside = 0.01;  // share of the depths that is left out at each end

uint64_t HashOf(uint64_t point_id, uint32_t image_id) {
  return RandomBits(kSeed, point_id, image_id);
}

}  // namespace

bool DepthSample::MayKeep(uint64_t point_id, uint32_t image_id) const {
  return HashOf(point_id, image_id) <= hash_limit_;
}

void DepthSample::Add(uint64_t point_id, uint32_t image_id, double depth_w) {
  if (!(depth_w > 0) || !std::isfinite(depth_w)) return;
  const uint64_t hash = HashOf(point_id, image_id);
  if (hash > hash_limit_) return;
  // Memory is reserved once, because a growing vector would need the old and the new memory at the
  // same time. Reserved memory that is not touched costs nothing.
  if (depths_.empty()) depths_.reserve(kMaxCount + 1);
  depths_.emplace_back(hash, depth_w);
  while (depths_.size() > kMaxCount && hash_limit_ > 0) {
    hash_limit_ /= 2;
    std::erase_if(depths_, [&](const auto& entry) { return entry.first > hash_limit_; });
  }
}

std::optional<DepthRange> DepthSample::Range() const {
  if (depths_.empty()) return std::nullopt;
  std::vector<double> sorted;
  sorted.reserve(depths_.size());
  for (const auto& [hash, depth_w] : depths_) sorted.push_back(depth_w);
  std::sort(sorted.begin(), sorted.end());
  const size_t outside =
      static_cast<size_t>(kShareOutside * static_cast<double>(sorted.size() - 1));
  return DepthRange{sorted[outside], sorted[sorted.size() - 1 - outside]};
}

}  // namespace lf
