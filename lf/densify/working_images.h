// SPDX-License-Identifier: Apache-2.0
// The working images of a light field, loaded when they are needed, within a limit of memory.
#pragma once

#include <cstddef>
#include <memory>

#include "lf/densify/kept_images.h"
#include "lf/densify/working_image.h"

namespace lf {

class WorkingImages {
 public:
  // Both must outlive this object.
  //   most_bytes  limit of the images that are kept for later use; images in use come on top
  WorkingImages(const LightField& light_field, const LfImageStore& store, int divisor,
                size_t most_bytes)
      : light_field_(light_field),
        store_(store),
        divisor_(divisor),
        curve_(light_field.encoding),
        kept_(most_bytes) {}

  // Returns the working image of an LF image. May be called by many threads at the same time; an
  // image is loaded once. Errors of LoadWorkingImage().
  Result<std::shared_ptr<const WorkingImage>> Get(LfImageId id);

 private:
  const LightField& light_field_;
  const LfImageStore& store_;
  const int divisor_;
  const ToneCurve curve_;
  KeptImages<WorkingImage> kept_;
};

}  // namespace lf
