// An octree over the places of LF cameras (thesis 4.2.1), so that a frame asks a few nodes instead
// of a million cameras.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/selection/seen_region.h"

namespace lf {

// Some 7 bytes for each LF camera. Refers to the light field.
class CameraTree {
 public:
  explicit CameraTree(const LightField& light_field);

  const LightField& light_field() const { return light_field_; }

  // Neighbouring cameras, a few dozen at most unless more stand at one place.
  size_t leaf_count() const { return leaf_begin_.size() - 1; }
  std::span<const LfImageId> Leaf(size_t leaf) const {
    return std::span(ids_).subspan(leaf_begin_[leaf], leaf_begin_[leaf + 1] - leaf_begin_[leaf]);
  }

  // Calls visit(leaf, all_inside) for every leaf with cameras that the region may hold, in
  // ascending order; all_inside: it holds all of them.
  void ForEachLeaf(const SeenRegion& region,
                   const std::function<void(size_t leaf, bool all_inside)>& visit) const;

 private:
  // Its children are the next node, that one's `next`, ... up to its own `next`.
  struct Node {
    float low[3], high[3];  // of the cameras' places, rounded outwards
    float axis[3];          // optical axes are within spread_rad of it
    float spread_rad;
    uint32_t next;  // the node after all below this one
    uint32_t leaf_begin, leaf_end;
  };
  struct Builder;

  const LightField& light_field_;
  std::vector<LfImageId> ids_;
  std::vector<uint32_t> leaf_begin_;  // [leaf_count() + 1] in ids_
  std::vector<Node> nodes_;           // a node before those below it
  double view_angle_rad_ = 0;         // no ray of any LF camera is farther from its optical axis
};

}  // namespace lf
