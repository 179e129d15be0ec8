// What selection asks a light field for again and again, made once: where its LF cameras stand, and
// at which places of the order their LF images are.
#pragma once

#include <cstdint>

#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/selection/camera_tree.h"
#include "lf/selection/image_order.h"

namespace lf {

// Refers to the light field. 12 bytes for each LF camera.
class ImageIndex {
 public:
  // places  of all its LF images, which may be a part of a larger light field's
  ImageIndex(const LightField& light_field, ImagePlaces places);
  // Shuffled.
  explicit ImageIndex(const LightField& light_field, uint64_t seed = 0);

  const LightField& light_field() const { return tree_.light_field(); }
  const CameraTree& tree() const { return tree_; }
  uint32_t PlaceOf(LfImageId id) const { return places_.of_images[id.value]; }
  // All places are below it.
  uint32_t place_end() const { return places_.end; }

 private:
  CameraTree tree_;
  ImagePlaces places_;
};

}  // namespace lf
