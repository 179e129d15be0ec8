// SPDX-License-Identifier: Apache-2.0
// Finds the range of the depths of a reconstruction's points. Internal to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "lf/light_field/model/light_field.h"

namespace lf {

// A random sample of at most kMaxCount depths. It does not depend on the order in which the depths
// are added: a depth is kept if the hash of its observation (point and image) is at most a limit,
// which is halved whenever there are more than kMaxCount depths.
class DepthSample {
 public:
  static constexpr size_t kMaxCount = size_t{1} << 20;

  // Returns true if Add() would keep a valid depth of this observation now. Most observations of a
  // large model are not kept; for these a caller can skip the computation of the depth.
  bool MayKeep(uint64_t point_id, uint32_t image_id) const;

  // Adds the depth of a point along the optical axis of one camera, in world units. A depth that is
  // not positive and finite is ignored, because the point is a mistake of the reconstruction.
  void Add(uint64_t point_id, uint32_t image_id, double depth_w);

  // Returns the range from the 1st to the 99th percentile of the depths; nullopt if there are no
  // depths.
  std::optional<DepthRange> Range() const;

 private:
  uint64_t hash_limit_ = UINT64_MAX;
  std::vector<std::pair<uint64_t, double>> depths_;  // hash and depth of each kept observation
};

}  // namespace lf
