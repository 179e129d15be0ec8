// What every frame of a film takes, found in the background while a person looks at the first.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/path/camera_path.h"
#include "lf/preprocess/frame_needs.h"
#include "lf/selection/image_index.h"

namespace lf {

class FilmUse {
 public:
  struct Facts {
    size_t frames_done = 0;                 // of those below; the others are 0
    std::vector<uint32_t> image_counts;     // of each frame, LF images
    std::vector<uint64_t> ray_counts;       // of each frame, pixels of their rectangles
    std::vector<uint16_t> frames_of_image;  // of each LF image, frames that take it; 65535 and more
  };

  // Begins at once, in a thread of its own. `on_progress` is called there: now and then, and in the
  // end. index and pool must outlive it.
  FilmUse(const ImageIndex& index, std::shared_ptr<const CameraPath> path,
          const NeedsOptions& options, ThreadPool& pool, std::function<void()> on_progress);
  ~FilmUse();  // leaves off
  FilmUse(const FilmUse&) = delete;
  FilmUse& operator=(const FilmUse&) = delete;

  Facts Get() const;
  // Until all frames are done.
  void Wait();

 private:
  void Run(const ImageIndex& index, NeedsOptions options, ThreadPool& pool);

  const std::shared_ptr<const CameraPath> path_;
  const std::function<void()> on_progress_;
  mutable std::mutex mutex_;
  Facts facts_;
  std::atomic<bool> is_left_ = false;
  std::thread thread_;
};

}  // namespace lf
