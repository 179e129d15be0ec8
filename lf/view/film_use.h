// SPDX-License-Identifier: Apache-2.0
// Counts the LF images and rays that the frames of a film need, in the background, while a person
// looks at the first frames. Frames that the page does not show are not counted (shown_frames.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "lf/camera/path/evaluate_path.h"
#include "lf/core/parallel.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/selection/image_index.h"

namespace lf {

class FilmUse {
 public:
  struct Facts {
    size_t frames_done = 0;              // number of shown frames counted so far, from the first on
    std::vector<uint32_t> image_counts;  // [shown frame]: number of LF images; 0 until counted
    // [shown frame]: sum of FrameNeeds::Image::ray_count; 0 until counted
    std::vector<uint64_t> ray_counts;
    // [LF image]: number of the frames that use it, at most 65535. In a long film, each counted
    // frame stands for those up to the next one.
    std::vector<uint16_t> frames_of_image;
  };

  // Starts counting at once in its own thread, which calls `on_progress` at most four times a
  // second, and after the last frame. `index` and `pool` must outlive this object.
  //   path  PathFrames::Check() has found no error in it
  FilmUse(const ImageIndex& index, std::shared_ptr<const PathFrames> path,
          const NeedsOptions& options, ThreadPool& pool, std::function<void()> on_progress);
  ~FilmUse();  // ends the thread, even if frames are left
  FilmUse(const FilmUse&) = delete;
  FilmUse& operator=(const FilmUse&) = delete;

  Facts Get() const;
  // Waits until all shown frames are done.
  void Wait();

 private:
  void Run(const ImageIndex& index, NeedsOptions options, ThreadPool& pool);

  const std::shared_ptr<const PathFrames> path_;
  const std::vector<FrameId> frames_;  // shown frames
  const std::function<void()> on_progress_;
  mutable std::mutex mutex_;
  Facts facts_;
  std::atomic<bool> is_left_ = false;
  std::thread thread_;
};

}  // namespace lf
