// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/working_images.h"

namespace lf {
namespace {

size_t BytesOf(const WorkingImage& image) {
  return image.light.size_bytes() + image.tones.size_bytes() + image.compared.size_bytes() +
         image.empty.size_bytes() + image.without_depth.size_bytes();
}

}  // namespace

Result<std::shared_ptr<const WorkingImage>> WorkingImages::Get(LfImageId id) {
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
  Result<WorkingImage> image = LoadWorkingImage(light_field_, store_, id, divisor_, curve_);
  lock.lock();
  loaded_.notify_all();
  Kept& kept = kept_[id];
  if (!image) {
    uses_.erase(kept.use);
    kept_.erase(id);
    return image.error();
  }
  kept.image = std::make_shared<const WorkingImage>(*std::move(image));
  bytes_ += BytesOf(*kept.image);
  std::shared_ptr<const WorkingImage> result = kept.image;
  DropOld();
  return result;
}

void WorkingImages::DropOld() {
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
