// SPDX-License-Identifier: Apache-2.0
// Images made of LF images, kept for later use within a limit of memory.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

template <class T>
class KeptImages {
 public:
  //   most_bytes  limit of the images that are kept; images in use come on top
  explicit KeptImages(size_t most_bytes) : most_bytes_(most_bytes) {}

  // Returns the image of `id`: one that is kept, or else the result of load(), whose errors are
  // passed on. May be called by many threads at the same time; an image is loaded once.
  //   bytes_of  bytes_of(image) returns the memory of an image
  template <class Load, class BytesOf>
  Result<std::shared_ptr<const T>> Get(LfImageId id, const Load& load, const BytesOf& bytes_of) {
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
    Result<T> image = load();
    lock.lock();
    loaded_.notify_all();
    Kept& kept = kept_[id];
    if (!image) {
      uses_.erase(kept.use);
      kept_.erase(id);
      return image.error();
    }
    kept.image = std::make_shared<const T>(*std::move(image));
    kept.bytes = bytes_of(*kept.image);
    bytes_ += kept.bytes;
    std::shared_ptr<const T> result = kept.image;
    DropOld();
    return result;
  }

 private:
  struct Kept {
    std::shared_ptr<const T> image;  // nullptr while a thread loads it
    std::list<LfImageId>::iterator use;
    size_t bytes = 0;
  };

  void DropOld() {
    for (auto use = uses_.end(); use != uses_.begin() && bytes_ > most_bytes_;) {
      --use;
      const auto found = kept_.find(*use);
      if (!found->second.image) continue;
      bytes_ -= found->second.bytes;
      kept_.erase(found);
      use = uses_.erase(use);
    }
  }

  const size_t most_bytes_;
  std::mutex mutex_;  // guards all members below
  std::condition_variable loaded_;
  std::unordered_map<LfImageId, Kept> kept_;
  std::list<LfImageId> uses_;  // the most recently used first
  size_t bytes_ = 0;
};

}  // namespace lf
