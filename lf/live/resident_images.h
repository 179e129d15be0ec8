// SPDX-License-Identifier: Apache-2.0
// The LF images that are kept in memory, shrunken, for live pictures. A thread loads those of the
// lens that is looked through, and forgets others when the memory is full.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/selection/image_index.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

class ResidentImages {
 public:
  // An LF image in memory.
  struct Image {
    LfPixels pixels;
    LfPixels opacity;  // LfPixels::TakeOpacity() of the pixels
  };
  // The LF images that are in memory at one moment. A snapshot keeps them in memory, even if
  // ResidentImages forgets them.
  struct Snapshot {
    struct Resident {
      LfImageId id;  // in `field`
      std::shared_ptr<const Image> image;
    };
    // The shrunken light field (ShrunkField()); null before the first LF image.
    std::shared_ptr<const LightField> field;
    std::vector<Resident> images;  // by ascending ids
  };
  struct Status {
    size_t resident_count = 0;  // LF images in memory
    size_t needed_count = 0;    // LF images that the frame of the last Aim() needs
    // Number of these for which memory has room. Both numbers are 0 until they are known.
    size_t wanted_count = 0;
    size_t wanted_done_count = 0;  // number of those that are in memory or broken
    size_t broken_count = 0;       // LF images that could not be loaded
    // The error of one of them, or why loading ended early, such as lack of memory; "" if there is
    // none. It is "" again once loading has succeeded.
    std::string first_broken;
    int divisor = 0;         // of ShrunkField(); 0 until it is known
    size_t image_bytes = 0;  // memory of an LF image; 0 until the divisor is known
    uint64_t version = 0;    // differs whenever any other number differs
  };

  //   index, store  of the whole light field; must outlive this object. The store must load RGB
  //                 (Mosaics::kToRgb)
  //   memory_bytes  bounds the memory of the shrunken LF images; at least one is kept. While LF
  //                 images are loaded, each of the threads has one more in full size
  //   threads       as ThreadPool
  //   retry_s       time from a failure to load until Aim() tries again, in seconds, because some
  //                 failures end: lack of memory, a disk that was not mounted
  //   changed       called after the status has changed, by any thread; may be empty
  ResidentImages(const ImageIndex& index, const LfImageStore& store, size_t memory_bytes,
                 int threads, std::function<void()> changed = {}, double retry_s = 5);
  ~ResidentImages();  // stops loading
  ResidentImages(const ResidentImages&) = delete;
  ResidentImages& operator=(const ResidentImages&) = delete;

  // Loads the LF images of this frame from now on: those whose rays pass through its lens, or
  // somewhat beside it, in the order of OrderOverLens(). If there are too many for the memory,
  // those that are loaded already are preferred. LF images that could not be loaded are tried again
  // after retry_s. Returns at once.
  void Aim(const RenderCamera& frame);

  // Returns the LF images in memory. Does not wait for LF images that are being loaded, and does
  // not keep others from being loaded. Forgotten LF images that snapshots hold may exceed the bound
  // of the memory by an eighth; if they exceed it further, loading waits until snapshots release
  // them.
  std::shared_ptr<const Snapshot> TakeSnapshot() const;  // is never null

  Status status() const;
  // Waits until all LF images that the last Aim() wants are in memory or broken.
  void WaitUntilLoaded();

 private:
  using Clock = std::chrono::steady_clock;
  struct Wanted {
    std::vector<LfImageId> ids;  // in the order in which they are loaded
    std::set<uint32_t> set;      // the same ids
    size_t needed_count = 0;     // Status::needed_count
  };
  void Run();
  void LoadFor(const RenderCamera& frame);
  bool TakesRetry();
  void UseDivisor(int divisor);
  Wanted WantedBy(const RenderCamera& frame);
  bool HasNews() const;
  void LoadSome(const Wanted& wanted, const std::vector<LfImageId>& some);
  LfPixels TakeSpare();
  void MakeRoom(const Wanted& wanted, size_t count);
  void WaitForForgotten();
  size_t ImageBytes() const;
  size_t Capacity() const;
  void Tell(const std::function<void(Status*)>& change);

  const ImageIndex& index_;
  const LfImageStore& store_;
  const size_t memory_bytes_;
  const std::function<void()> changed_;
  const std::chrono::duration<double> retry_after_;
  ThreadPool pool_;

  // Held while the loader changes the next three members, or while another thread reads them.
  mutable std::mutex images_mutex_;
  std::shared_ptr<const LightField> field_;
  std::map<uint32_t, std::shared_ptr<const Image>> images_;
  // Made by TakeSnapshot(); null again once the members above have changed.
  mutable std::shared_ptr<const Snapshot> snapshot_;
  // The members up to mutex_ are only for the loader.
  std::vector<std::weak_ptr<const Image>> forgotten_;  // some may still be in snapshots
  std::map<uint32_t, std::string> broken_;  // errors of LF images that could not be loaded

  mutable std::mutex mutex_;  // guards the members below, except thread_
  std::condition_variable news_;
  std::optional<RenderCamera> aim_;   // the newest frame of Aim() until the loader takes it
  std::optional<RenderCamera> last_;  // the frame that the loader has taken last
  bool is_loading_ = false;
  std::vector<LfPixels> spare_;  // memory that is reused for LF images in full size
  Clock::time_point failed_at_;  // time of the last failure to load
  std::atomic<bool> is_ending_ = false;
  Status status_;
  std::thread thread_;
};

}  // namespace lf
