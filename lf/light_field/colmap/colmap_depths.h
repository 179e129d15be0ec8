// The range of depths of the points of a reconstruction. Internal to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "lf/light_field/model/light_field.h"

namespace lf {

// A sample of depths with bounded size that does not depend on their order: a depth is kept if the
// hash of its observation is below a limit, which is halved whenever there are too many depths.
class DepthSample {
 public:
  static constexpr size_t kMaxCount = size_t{1} << 20;

  // Returns true if Add() would now keep a depth of this observation. Few of very many are kept, so
  // a caller can skip work for the others.
  bool MayKeep(uint64_t point_id, uint32_t image_id) const;

  // Adds the depth of a point in one camera. Depths that are not positive and finite are ignored:
  // such a point is a mistake of the reconstruction.
  void Add(uint64_t point_id, uint32_t image_id, double depth_w);

  // Returns the 1st to the 99th percentile; nullopt without depths.
  std::optional<DepthRange> Range() const;

 private:
  uint64_t hash_limit_ = UINT64_MAX;
  std::vector<std::pair<uint64_t, double>> depths_;  // with their hashes
};

}  // namespace lf
