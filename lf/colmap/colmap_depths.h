// The range of depths in which the points of a reconstruction lie. Internal to colmap.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "lf/capture/light_field.h"

namespace lf {

// A sample of depths of bounded size, the same in whatever order they come: a depth is kept if the
// hash of its observation is below a limit, which is halved whenever there are too many.
class DepthSample {
 public:
  static constexpr size_t kMaxCount = size_t{1} << 20;

  // Whether Add would keep a depth of this observation now. Of very many it keeps few: what takes
  // time to find need not be looked for.
  bool MayKeep(uint64_t point_id, uint32_t image_id) const;

  // A point as one camera sees it. Depths that are not positive and finite do not count: such a
  // point is a mistake of the reconstruction.
  void Add(uint64_t point_id, uint32_t image_id, double depth_w);

  // From the 1st to the 99th percentile; none without depths.
  std::optional<DepthRange> Range() const;

 private:
  uint64_t hash_limit_ = UINT64_MAX;
  std::vector<std::pair<uint64_t, double>> depths_;  // with their hashes
};

}  // namespace lf
