// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_images.h"

#include <utility>

namespace lf {
namespace {

size_t BytesOf(const JointImage& image) {
  const WorkingImage& working = image.working;
  return image.samples.size_bytes() + image.rgb.size_bytes() + image.smooth.size_bytes() +
         working.tones.size_bytes() + working.compared.size_bytes() + working.empty.size_bytes() +
         working.without_depth.size_bytes();
}

}  // namespace

Result<JointImage> JointImages::Load(LfImageId id) const {
  const Intrinsics& k = light_field_.Camera(id).intrinsics;
  LF_ASSIGN_OR_RETURN(const LfPixels mosaic,
                      LoadWithoutThrowing(store_, id, {0, 0, k.width_px, k.height_px},
                                          light_field_.image_names[id.value], LfPixels{}));
  return JointImageOf(light_field_, id, mosaic, curve_);
}

Result<std::shared_ptr<const JointImage>> JointImages::Get(LfImageId id) {
  std::unique_lock lock(mutex_);
  for (auto found = kept_.find(id); found != kept_.end(); found = kept_.find(id)) {
    if (!found->second.image) {
      loaded_.wait(lock);
      continue;
    }
    uses_.splice(uses_.begin(), uses_, found->second.use);
    return found->second.image;
  }
  uses_.push_front(id);
  kept_[id] = {nullptr, uses_.begin()};
  lock.unlock();
  Result<JointImage> image = Load(id);
  lock.lock();
  loaded_.notify_all();
  Kept& kept = kept_[id];
  if (!image) {
    uses_.erase(kept.use);
    kept_.erase(id);
    return image.error();
  }
  kept.image = std::make_shared<const JointImage>(*std::move(image));
  bytes_ += BytesOf(*kept.image);
  std::shared_ptr<const JointImage> result = kept.image;
  DropOld();
  return result;
}

void JointImages::DropOld() {
  for (auto use = uses_.end(); use != uses_.begin() && bytes_ > most_bytes_;) {
    --use;
    const auto found = kept_.find(*use);
    if (!found->second.image) continue;
    bytes_ -= BytesOf(*found->second.image);
    kept_.erase(found);
    use = uses_.erase(use);
  }
}

}  // namespace lf
