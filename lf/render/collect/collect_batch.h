// A batch of decoded LF images, added to the plates of all frames by all threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/gather.h"
#include "lf/collection/gather_sampling.h"
#include "lf/collection/scatter.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/noise_moments.h"
#include "lf/render/collect/shared_ideal_pixels.h"
#include "lf/selection/overlap.h"
#include "lf/selection/select.h"

namespace lf {

// How rays are found (doc/ray.md, "What is added"). kNearest: every LF pixel looks for its element.
// kBilinear: every element looks for its position in each LF image, which must be RGB.
enum class Estimator { kNearest, kBilinear };

// Returns "nearest" or "bilinear".
const char* NameOf(Estimator estimator);

// How rays are made of pixels.
struct RayReading {
  Estimator estimator = Estimator::kNearest;
  PixelFilter filter = PixelFilter::kAuto;  // for kBilinear
};

// Returns which pixels of an LF image its rays need, for selection.
PixelReach ReachOf(Estimator estimator);

// kReference applies the ray model to every pixel, on one thread. It is some 50 times slower, and
// judges kFast.
enum class CollectBackEnd { kFast, kReference };

struct FrameRays {
  uint64_t image_count = 0;   // LF images with an accepted ray
  uint64_t tested_count = 0;  // pixels of the rectangles of all LF images
  uint64_t accepted_count = 0;
};

struct BatchImage {
  LfImageId id;
  uint32_t place = 0;  // in the order of the LF images
  LfPixels pixels;
  LfPixels opacity = {};  // of these pixels, for plates that have it (LfPixels::TakeOpacity)
  // Filled by BatchCollector. Without lens distortion there are no cells and no ideal pixels.
  std::shared_ptr<const std::vector<IdealCell>> cells = nullptr;
  std::shared_ptr<const IdealPixels> ideal_pixels = nullptr;
  std::optional<ImageOverlap> overlap = std::nullopt;
};

// A frame that takes the images of a batch whose places are in `places`.
struct BatchFrame {
  size_t frame = 0;
  PlaceRange places;
  bool is_done = false;  // answer of Add(): all of these images are in the plate, or none
  FrameRays rays;        // answer of Add(), if it is done
};

// Work that has nothing to do with the batch, done by the same threads at the same time.
struct OtherItems {
  size_t count = 0;
  std::function<void(size_t)> run;
};

// Returns about how many bytes the plan of the rays of one LF image in one frame takes. nearest
// plans the scanlines of the image. bilinear plans those of the plate, or of a finer plate that is
// at most twice as fine as the image.
size_t PlanBytes(Estimator estimator, bool has_distortion, int image_width, int image_height,
                 int plate_width, int plate_height);

// Returns the weights of the rays of an LF image in a frame; 0 if the image takes no part in it. An
// empty function stands for 1.
using FrameImageWeights = std::function<RayWeights(size_t frame, LfImageId id)>;

class BatchCollector {
 public:
  // plan_bytes    of the plans of frames that are planned together; one frame may take more
  // whole_images  take whole images instead of their rectangles
  // moments       one per frame, for plates of their sizes; null: none are kept
  BatchCollector(const LightField& light_field, std::span<const RenderCamera> frames,
                 const RayReading& reading, CollectBackEnd back_end, FrameImageWeights weights,
                 size_t plan_bytes, bool whole_images, ThreadPool& pool,
                 std::vector<SensorPlate>* plates, std::vector<NoiseMoments>* moments = nullptr);

  // Adds the images to the plates of `frames`, whose order may change, and runs the other items.
  // Once *interrupted is true no further frame is begun, and those begun are finished; other items
  // may then be left out.
  void Add(std::vector<BatchImage>& batch, std::vector<BatchFrame>& frames,
           const OtherItems& other_items, const std::atomic<bool>* interrupted);

  // Returns the bounds of the pixels of an LF image that some of `frames` need. Frames in which the
  // image has no weight need none.
  PixelRect RectOf(LfImageId id, std::span<const size_t> frames) const;

  // CPU seconds that all threads have spent on batches so far, without other items.
  double cpu_seconds() const { return static_cast<double>(cpu_ns_.load()) * 1e-9; }

 private:
  // One LF image in one frame.
  struct Contribution {
    PixelRect rect;
    ScatterPlan scatter;  // planned if the estimator is nearest, otherwise `gather`
    GatherPlan gather;
    RayWeights weights;
    std::atomic<uint64_t> accepted_count = 0;
  };
  PixelRect RectOf(const BatchImage& image, const RenderCamera& frame) const;
  RayWeights WeightsOf(size_t frame, LfImageId id) const {
    return weights_ ? weights_(frame, id) : RayWeights();
  }
  NoiseMoments* MomentsOf(size_t frame) const {
    return moments_ == nullptr ? nullptr : &(*moments_)[frame];
  }
  void UndoDistortion(std::vector<BatchImage>& batch);
  std::span<BatchFrame> FramesThatMayTake(const std::vector<BatchImage>& batch,
                                          std::span<BatchFrame> frames);
  void AddToFrames(const std::vector<BatchImage>& batch, std::span<BatchFrame> frames,
                   const OtherItems& other_items, const std::atomic<bool>* interrupted);
  uint64_t AddToTile(const Contribution& contribution, size_t tile, const LfPixels& pixels,
                     TileSums* sums) const;
  void AddByReference(const std::vector<BatchImage>& batch, BatchFrame* frame);
  void AddOpacityByReference(const BatchImage& image, const PixelRect& rect,
                             const RenderCamera& camera, const RayWeights& weights,
                             SensorPlate* plate) const;
  void ForEachTimed(size_t count, const std::function<void(size_t)>& body);

  const LightField& light_field_;
  std::span<const RenderCamera> frames_;
  RayReading reading_;
  CollectBackEnd back_end_;
  FrameImageWeights weights_;
  size_t plan_bytes_;
  bool whole_images_;
  ThreadPool& pool_;
  std::vector<SensorPlate>& plates_;
  std::vector<NoiseMoments>* moments_;
  std::vector<std::vector<PlateTile>> tiles_;
  // One for each LF image of a batch in each frame. Every batch uses their memory again.
  std::deque<Contribution> contributions_;
  SharedIdealPixels ideal_pixels_;
  std::atomic<int64_t> cpu_ns_ = 0;
};

}  // namespace lf
