// SPDX-License-Identifier: Apache-2.0
#include "lf/view/film_use.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "lf/view/shown_frames.h"

namespace lf {
namespace {

constexpr std::chrono::milliseconds kBetweenWords(250);

}  // namespace

FilmUse::FilmUse(const ImageIndex& index, std::shared_ptr<const PathFrames> path,
                 const NeedsOptions& options, ThreadPool& pool, std::function<void()> on_progress)
    : path_(std::move(path)),
      frames_(ShownFrames(path_->frames())),
      on_progress_(std::move(on_progress)) {
  facts_.image_counts.assign(frames_.size(), 0);
  facts_.ray_counts.assign(frames_.size(), 0);
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
  for (size_t i = 0; i < frames_.size(); ++i) {
    const size_t end = i + 1 < frames_.size() ? frames_[i + 1].value : frames_[i].value + 1;
    const size_t stands_for = end - frames_[i].value;
    const FrameNeeds needs = NeedsOf(index, *path_->Camera(frames_[i]), options, pool);
    if (is_left_) return;
    {
      const std::lock_guard lock(mutex_);
      facts_.image_counts[i] = static_cast<uint32_t>(needs.images.size());
      facts_.ray_counts[i] = needs.RayCount();
      for (const FrameNeeds::Image& image : needs.images) {
        uint16_t& count = facts_.frames_of_image[image.id.value];
        count = static_cast<uint16_t>(std::min<size_t>(count + stands_for, UINT16_MAX));
      }
      facts_.frames_done = i + 1;
    }
    if (Clock::now() - told < kBetweenWords && i + 1 < frames_.size()) continue;
    told = Clock::now();
    on_progress_();
  }
}

}  // namespace lf
