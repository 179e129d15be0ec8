// Finds in the background what each frame of a film needs, while a person looks at the first.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/parallel.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/selection/image_index.h"

namespace lf {

class FilmUse {
 public:
  struct Facts {
    size_t frames_done = 0;                 // frames counted below; the others are 0
    std::vector<uint32_t> image_counts;     // number of LF images per frame
    std::vector<uint64_t> ray_counts;       // number of pixels in the rectangles per frame
    std::vector<uint16_t> frames_of_image;  // number of frames that use each LF image, at most
                                            // 65535
  };

  // Starts at once, in a thread of its own, which calls `on_progress` now and then and at the end.
  // index and pool must outlive it.
  FilmUse(const ImageIndex& index, std::shared_ptr<const CameraPath> path,
          const NeedsOptions& options, ThreadPool& pool, std::function<void()> on_progress);
  ~FilmUse();  // stops early
  FilmUse(const FilmUse&) = delete;
  FilmUse& operator=(const FilmUse&) = delete;

  Facts Get() const;
  // Waits until all frames are done.
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
