// SPDX-License-Identifier: Apache-2.0
// The working images of a light field, loaded when they are needed, within a limit of memory.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

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
        most_bytes_(most_bytes),
        curve_(light_field.encoding) {}

  // Returns the working image of an LF image. May be called by many threads at the same time; an
  // image is loaded once. Errors of LoadWorkingImage().
  Result<std::shared_ptr<const WorkingImage>> Get(LfImageId id);

 private:
  struct Kept {
    std::shared_ptr<const WorkingImage> image;  // nullptr while a thread loads it
    std::list<LfImageId>::iterator use;
  };
  void DropOld();

  const LightField& light_field_;
  const LfImageStore& store_;
  const int divisor_;
  const size_t most_bytes_;
  const ToneCurve curve_;

  std::mutex mutex_;  // guards all members below
  std::condition_variable loaded_;
  std::unordered_map<LfImageId, Kept> kept_;
  std::list<LfImageId> uses_;  // the last used first
  size_t bytes_ = 0;
};

}  // namespace lf
