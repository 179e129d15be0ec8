// SPDX-License-Identifier: Apache-2.0
#include "lf/view/film_use.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace lf {
namespace {

constexpr std::chrono::milliseconds kBetweenWords(250);

}  // namespace

FilmUse::FilmUse(const ImageIndex& index, std::shared_ptr<const CameraPath> path,
                 const NeedsOptions& options, ThreadPool& pool, std::function<void()> on_progress)
    : path_(std::move(path)), on_progress_(std::move(on_progress)) {
  facts_.image_counts.assign(path_->frame_count(), 0);
  facts_.ray_counts.assign(path_->frame_count(), 0);
  facts_.frames_of_image.assign(index.light_field().size(), 0);
  thread_ = std::thread([this, &index, options, &pool] { Run(index, options, pool); });
}

FilmUse::~FilmUse() {
  is_left_ = true;
  Wait();
}

void FilmUse::Wait() {
  if (thread_.joinable()) thread_.join();
}

FilmUse::Facts FilmUse::Get() const {
  const std::lock_guard lock(mutex_);
  return facts_;
}

void FilmUse::Run(const ImageIndex& index, NeedsOptions options, ThreadPool& pool) {
  using Clock = std::chrono::steady_clock;
  options.select.interrupted = &is_left_;
  Clock::time_point told = Clock::now();
  for (size_t i = 0; i < path_->frame_count(); ++i) {
    const FrameNeeds needs = NeedsOf(index, path_->cameras[i], options, pool);
    if (is_left_) return;
    {
      const std::lock_guard lock(mutex_);
      facts_.image_counts[i] = static_cast<uint32_t>(needs.images.size());
      facts_.ray_counts[i] = needs.RayCount();
      for (const FrameNeeds::Image& image : needs.images) {
        uint16_t& count = facts_.frames_of_image[image.id.value];
        if (count < UINT16_MAX) ++count;
      }
      facts_.frames_done = i + 1;
    }
    if (Clock::now() - told < kBetweenWords && i + 1 < path_->frame_count()) continue;
    told = Clock::now();
    on_progress_();
  }
}

}  // namespace lf
