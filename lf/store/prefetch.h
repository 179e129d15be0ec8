// Loader threads and a bounded queue: decoding of the next LF images overlaps collection, and no
// more than a few are in memory (thesis 4.4).
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

struct LoadRequest {
  LfImageId id;
  PixelRect rect;
};

struct LoadedImage {
  LfImageId id;
  Result<LfPixels> pixels;
};

struct PrefetchOptions {
  int thread_count = 1;                  // loader threads; 0: Next() loads, itself
  size_t queue_bytes = size_t{1} << 30;  // decoded images waiting or being decoded, at least one
  // Of one decoded image. 0: learnt from the first one, which is then loaded alone.
  size_t image_bytes_estimate = 0;
};

// Delivers the requested images in their order. The store must outlive it.
//
// An image takes its estimated bytes of the queue from the moment a thread begins with it, and its
// true ones from when it is decoded until Next() hands it over; larger ones raise the estimate.
// What a store throws for want of memory becomes that image's error (kOutput); where the machine
// refuses threads, fewer do the work.
class Prefetcher {
 public:
  Prefetcher(const LfImageStore& store, std::vector<LoadRequest> requests,
             const PrefetchOptions& options);
  ~Prefetcher();  // stops the threads, also in the middle; waits for loads that have begun
  Prefetcher(const Prefetcher&) = delete;
  Prefetcher& operator=(const Prefetcher&) = delete;

  // The next image or its error; none at the end. Waits for it. One caller at a time.
  std::optional<LoadedImage> Next();

  // CPU seconds spent in Load() so far, all threads.
  double load_seconds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lf
