// SPDX-License-Identifier: Apache-2.0
// An octree over the positions of the LF cameras (thesis 4.2.1). With it, selection tests a few
// nodes for each frame instead of a million LF cameras.
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

// Takes about 7 bytes of memory for each LF camera. Refers to the light field, which must outlive
// the tree.
class CameraTree {
 public:
  // The LF cameras that a tree contains.
  enum class Content : uint8_t { kAll, kRecorded };
  explicit CameraTree(const LightField& light_field, Content content = Content::kAll);

  const LightField& light_field() const { return light_field_; }

  // A leaf contains neighbouring LF cameras: at most 32, unless more have almost the same position.
  size_t leaf_count() const { return leaf_begin_.size() - 1; }
  std::span<const LfImageId> Leaf(size_t leaf) const {
    return std::span(ids_).subspan(leaf_begin_[leaf], leaf_begin_[leaf + 1] - leaf_begin_[leaf]);
  }

  // Calls visit(leaf, all_inside), by ascending leaves, for every leaf with LF cameras that may
  // have rays for the frame of `region`. all_inside is true if region.Misses() is known to be false
  // for all LF cameras of the leaf.
  void ForEachLeaf(const SeenRegion& region,
                   const std::function<void(size_t leaf, bool all_inside)>& visit) const;

 private:
  // The first child of node n is node n + 1. The next child is the `next` of the child before it.
  // The last child has the same `next` as node n.
  struct Node {
    float low[3], high[3];  // bounds of the LF cameras' positions, rounded outwards
    float axis[3];  // unit vector; at most spread_rad from the optical axis of each LF camera
    float spread_rad;
    uint32_t next;  // index of the node after all nodes below this one
    uint32_t leaf_begin, leaf_end;
  };
  struct Builder;

  const LightField& light_field_;
  std::vector<LfImageId> ids_;
  std::vector<uint32_t> leaf_begin_;  // [leaf_count() + 1]: index of a leaf's first entry in ids_
  std::vector<Node> nodes_;           // a node is before the nodes below it
  double view_angle_rad_ = 0;         // largest angle between a ray and its LF camera's axis
};

}  // namespace lf
