// SPDX-License-Identifier: Apache-2.0
// Mosaics of a light field in the form JointImage, loaded when they are needed, within a limit of
// memory. Internal to this folder.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "lf/core/result.h"
#include "lf/densify/demosaic/joint_image.h"
#include "lf/densify/working_image.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

class JointImages {
 public:
  // Both must outlive this object. The store loads mosaics as recorded.
  //   most_bytes  limit of the images that are kept for later use; images in use come on top
  JointImages(const LightField& light_field, const LfImageStore& store, size_t most_bytes)
      : light_field_(light_field),
        store_(store),
        most_bytes_(most_bytes),
        curve_(light_field.encoding) {}

  // May be called by many threads at the same time; an image is loaded once. kInput, kOutput: the
  // LF image cannot be loaded.
  Result<std::shared_ptr<const JointImage>> Get(LfImageId id);

 private:
  struct Kept {
    std::shared_ptr<const JointImage> image;  // nullptr while a thread loads it
    std::list<LfImageId>::iterator use;
  };
  Result<JointImage> Load(LfImageId id) const;
  void DropOld();

  const LightField& light_field_;
  const LfImageStore& store_;
  const size_t most_bytes_;
  const ToneCurve curve_;

  std::mutex mutex_;  // guards all members below
  std::condition_variable loaded_;
  std::unordered_map<LfImageId, Kept> kept_;
  std::list<LfImageId> uses_;  // the last used first
  size_t bytes_ = 0;
};

}  // namespace lf
