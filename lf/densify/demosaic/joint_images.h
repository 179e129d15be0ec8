// SPDX-License-Identifier: Apache-2.0
// Mosaics of a light field in the form JointImage, loaded when they are needed, within a limit of
// memory. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "lf/core/result.h"
#include "lf/densify/demosaic/joint_image.h"
#include "lf/densify/kept_images.h"
#include "lf/densify/working_image.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

class JointImages {
 public:
  // Both must outlive this object. The store loads mosaics as recorded.
  //   most_bytes  limit of the images that are kept for later use; images in use come on top
  JointImages(const LightField& light_field, const LfImageStore& store, size_t most_bytes)
      : light_field_(light_field), store_(store), curve_(light_field.encoding), kept_(most_bytes) {}

  // May be called by many threads at the same time; an image is loaded once. kInput, kOutput: the
  // LF image cannot be loaded.
  Result<std::shared_ptr<const JointImage>> Get(LfImageId id);

 private:
  Result<JointImage> Load(LfImageId id) const;

  const LightField& light_field_;
  const LfImageStore& store_;
  const ToneCurve curve_;
  KeptImages<JointImage> kept_;
};

}  // namespace lf
