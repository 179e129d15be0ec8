// SPDX-License-Identifier: Apache-2.0
// An index of a light field, made once for many selections: an octree of the LF cameras, and the
// rank of each LF image in the order (image_order.h).
#pragma once

#include <cstdint>
#include <memory>

#include "lf/core/ids.h"
#include "lf/light_field/model/light_field.h"
#include "lf/selection/camera_tree.h"
#include "lf/selection/image_order.h"

namespace lf {

// Refers to the light field, which must outlive the index. Takes about 12 bytes of memory for each
// LF camera.
class ImageIndex {
 public:
  //   ranks  ranks (image_order.h) of all LF images of light_field, which may be a package: a part
  //           of a larger light field
  ImageIndex(const LightField& light_field, ImageRanks ranks);
  // Makes an index with the random order that ShuffledRanks() makes from `seed`.
  explicit ImageIndex(const LightField& light_field, uint64_t seed = 0);

  const LightField& light_field() const { return tree_.light_field(); }
  const CameraTree& tree() const { return tree_; }
  uint32_t RankOf(LfImageId id) const { return ranks_.of_images[id.value]; }
  // Exclusive upper bound of all ranks.
  uint32_t rank_end() const { return ranks_.end; }
  // Returns an index of the recorded LF images alone, with the same ids and ranks: this index if
  // no LF image is virtual.
  const ImageIndex& recorded() const { return recorded_ ? *recorded_ : *this; }
  // Returns true if the index leaves out virtual LF images.
  bool is_of_recorded() const { return content_ == CameraTree::Content::kRecorded; }

 private:
  ImageIndex(const LightField& light_field, ImageRanks ranks, CameraTree::Content content);

  CameraTree::Content content_;
  CameraTree tree_;
  ImageRanks ranks_;
  std::unique_ptr<ImageIndex> recorded_;  // null if no LF image is virtual
};

}  // namespace lf
