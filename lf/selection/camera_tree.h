// An octree over the positions of LF cameras (thesis 4.2.1), so that a frame tests a few nodes
// instead of a million cameras.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/light_field/model/light_field.h"
#include "lf/selection/seen_region.h"

namespace lf {

// Takes about 7 bytes for each LF camera. Refers to the light field, which must outlive it.
class CameraTree {
 public:
  explicit CameraTree(const LightField& light_field);

  const LightField& light_field() const { return light_field_; }

  // A leaf has neighbouring cameras: a few dozen at most, unless more stand at one position.
  size_t leaf_count() const { return leaf_begin_.size() - 1; }
  std::span<const LfImageId> Leaf(size_t leaf) const {
    return std::span(ids_).subspan(leaf_begin_[leaf], leaf_begin_[leaf + 1] - leaf_begin_[leaf]);
  }

  // Calls visit(leaf, all_inside), in ascending order, for every leaf with cameras that may be in
  // the region. all_inside is true if all of its cameras are known to be in the region.
  void ForEachLeaf(const SeenRegion& region,
                   const std::function<void(size_t leaf, bool all_inside)>& visit) const;

 private:
  // The first child of a node is the node behind it, the second is the first one's `next`, and so
  // on up to the node's own `next`.
  struct Node {
    float low[3], high[3];  // bounds of the cameras' positions, rounded outwards
    float axis[3];          // optical axes are within spread_rad of it
    float spread_rad;
    uint32_t next;  // the node after all below this one
    uint32_t leaf_begin, leaf_end;
  };
  struct Builder;

  const LightField& light_field_;
  std::vector<LfImageId> ids_;
  std::vector<uint32_t> leaf_begin_;  // [leaf_count() + 1] in ids_
  std::vector<Node> nodes_;           // each node precedes the nodes below it
  double view_angle_rad_ = 0;         // no ray of any LF camera is farther from its optical axis
};

}  // namespace lf
