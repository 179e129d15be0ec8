// Ray collection over many LF images and frames: images are read once, in order, and every core
// works on any number of frames, even one (doc/design.md, "Work is cut by destination").
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/capture/light_field.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/plate/sensor_plate.h"
#include "lf/selection/select.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// Who asks whom (doc/ray.md, "What is added"): every LF pixel looks for its element, or every
// element for its place in each LF image, which must be RGB.
enum class Estimator { kNearest, kBilinear };

// "nearest", "bilinear"
const char* NameOf(Estimator estimator);

// Which pixels of an LF image its rays need, for selection.
PixelReach ReachOf(Estimator estimator);

// kReference asks the law of every pixel, on one thread: the judge, some 50 times slower.
enum class CollectBackEnd { kFast, kReference };

struct CollectOptions {
  Estimator estimator = Estimator::kNearest;
  CollectBackEnd back_end = CollectBackEnd::kFast;
  int batch_image_count = 16;              // LF images collected together into a tile of the plate
  size_t queue_bytes = size_t{256} << 20;  // decoded LF images waiting
  size_t image_bytes = 0;                  // of one decoded LF image
  int loader_count = 2;
  bool strict = false;                             // a broken LF image is an error
  const std::atomic<bool>* interrupted = nullptr;  // looked at between batches
};

struct FrameRays {
  uint64_t image_count = 0;   // LF images with an accepted ray
  uint64_t tested_count = 0;  // pixels of their rectangles
  uint64_t accepted_count = 0;
};

struct SkippedImage {
  std::string name;
  std::string reason;
};

struct CollectStatistics {
  std::vector<FrameRays> frames;  // as the frames given
  std::vector<SkippedImage> skipped;
  double load_cpu_s = 0;      // of the loader threads
  double collect_wall_s = 0;  // without waiting for images
};

struct CollectProgress {
  size_t image_count = 0;
  uint64_t tested_count = 0;
};

// Adds the rays of `images`, in their order, to `plates`, one per frame. The result has the same
// bits for any order, batch size and number of threads; a broken image that is skipped leaves the
// plates as if it had not been there.
// kInput: a broken image when strict. kOutput: loading ran out of memory. kInterrupted.
Result<CollectStatistics> Collect(const LightField& light_field, const LfImageStore& store,
                                  std::span<const RenderCamera> frames,
                                  std::span<const SelectedImage> images,
                                  const CollectOptions& options, ThreadPool& pool,
                                  std::vector<SensorPlate>* plates,
                                  const std::function<void(const CollectProgress&)>& progress);

}  // namespace lf
