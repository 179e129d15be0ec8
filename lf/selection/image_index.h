// What selection asks a light field for again and again, made once: where its LF cameras stand, and
// in which order its LF images are taken.
//
// The image order is a shuffle of all LF cameras of the light field by a seed; the *place* of an LF
// image is its rank there, from 0. It does not depend on frames, so that what is counted in places
// (limits, stop rules, how far an interrupted frame has come) means the same for any choice of
// frames and any passes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/selection/camera_tree.h"

namespace lf {

// All LF images by their places: the shuffle.
std::vector<LfImageId> ImageOrder(size_t image_count, uint64_t seed);

// Refers to the light field. 16 bytes for each LF camera.
class ImageIndex {
 public:
  explicit ImageIndex(const LightField& light_field, uint64_t seed = 0);

  const LightField& light_field() const { return tree_.light_field(); }
  const CameraTree& tree() const { return tree_; }
  LfImageId AtPlace(uint32_t place) const { return order_[place]; }
  uint32_t PlaceOf(LfImageId id) const { return places_[id.value]; }

 private:
  CameraTree tree_;
  std::vector<LfImageId> order_;
  std::vector<uint32_t> places_;
};

}  // namespace lf
