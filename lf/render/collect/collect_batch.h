// SPDX-License-Identifier: Apache-2.0
// Adds the rays of a batch of decoded LF images to the plates of all frames, with all threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
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
#include "lf/render/collect/collected_frame.h"
#include "lf/render/collect/defocus.h"
#include "lf/render/collect/shared_ideal_pixels.h"
#include "lf/render/settings/ray_reading.h"
#include "lf/selection/overlap.h"
#include "lf/selection/select.h"

namespace lf {

struct BatchImage {
  LfImageId id;
  uint32_t rank = 0;  // rank of the LF image in the order
  LfPixels pixels;
  // Only used by plates with opacity or a guard: the opacity of these pixels
  // (LfPixels::TakeOpacity()), or their opacity and trust (TakeOpacityAndTrust()) if the plates
  // have a guard.
  LfPixels opacity = {};
  NearbyDepths depths = {};  // of a recorded LF image; only used by guarded plates
  // Pixels and their opacity that others own and may read at the same time, instead of `pixels` and
  // `opacity`. BatchCollector::Add() must then keep the pixels. Null: not used.
  const LfPixels* shared_pixels = nullptr;
  const LfPixels* shared_opacity = nullptr;
  // The prefilter whose result has replaced `pixels` and `opacity`; unset if they are as loaded.
  // The caller may filter them. It must then set `loaded`, and set `filtered_by` to the result of
  // OnlyPrefilterOf() for all frames that take the LF image.
  std::optional<Prefilter> filtered_by = std::nullopt;
  PixelRect loaded = {};  // rectangle of the pixels before they were filtered
  // BatchCollector sets the members below. If the LF camera has no lens distortion, *cells is
  // empty. `ideal_pixels` is then null, as it always is with kBilinear or kReference.
  std::shared_ptr<const std::vector<IdealCell>> cells = nullptr;
  std::shared_ptr<const IdealPixels> ideal_pixels = nullptr;
  std::optional<ImageOverlap> overlap = std::nullopt;

  const LfPixels& Pixels() const { return shared_pixels ? *shared_pixels : pixels; }
  const LfPixels& Opacity() const { return shared_pixels ? *shared_opacity : opacity; }
};

// A frame that takes those LF images of a batch whose ranks are in `ranks`.
// BatchCollector::Add() sets `is_done` and `rays`.
struct BatchFrame {
  size_t frame = 0;  // index in the frames of the BatchCollector
  RankRange ranks;
  // true: the plate has the rays of all these LF images; false: it has the rays of none of them
  bool is_done = false;
  FrameRays rays;  // counts of the rays that Add() tested and added; zeros if is_done is false
};

// Work other than collecting rays, such as decoding the next batch, that the threads of the pool do
// at the same time. It has `count` items; run(i) does item i.
struct OtherItems {
  size_t count = 0;
  std::function<void(size_t)> run;
};

// Returns the approximate size, in bytes, of the plan of one LF image's rays in one frame: a
// ScatterPlan (kNearest) or GatherPlan (kBilinear). kNearest plans the scanlines of the LF image.
// kBilinear plans the scanlines of the plate, or of a finer plate with at most twice the resolution
// of the LF image.
//   surface  the focal surface of the frame, each piece of which has segments of its own; null:
//            there is none
size_t PlanBytes(Estimator estimator, bool has_distortion, int image_width, int image_height,
                 int plate_width, int plate_height, const FocalSurface* surface = nullptr);

class FilteredImages;

class BatchCollector {
 public:
  // frames        must outlive the object; their `ranks` are not used, because BatchFrame has its
  //               own
  // plan_bytes    memory for the plans of frames that are planned together; exceeded if one frame
  //               needs more
  // whole_images  true: tests all loaded pixels of an LF image instead of the rectangle that a
  //               frame needs
  BatchCollector(const LightField& light_field, std::span<const CollectedFrame> frames,
                 const RayReading& reading, CollectBackEnd back_end, size_t plan_bytes,
                 bool whole_images, ThreadPool& pool);
  ~BatchCollector();

  // Adds the rays of the LF images to the plates of `frames`, and runs `other_items`. May change
  // the order of `frames`. Once *interrupted is true, no further frame gets rays of the batch, but
  // the frames that have some of these rays get all of them. Items of `other_items` may then be
  // left out. `interrupted` may be null.
  //   keep_pixels  true: the LF images stay as loaded; false: an LF image that needs only one
  //                prefilter may be filtered in its own memory
  void Add(std::vector<BatchImage>& batch, std::vector<BatchFrame>& frames,
           const OtherItems& other_items, bool keep_pixels, const std::atomic<bool>* interrupted);

  // Returns the bounds of the pixels of an LF image that at least one of `frames` (indices) needs.
  // A frame in which the LF image has no weight needs no pixels.
  PixelRect RectOf(LfImageId id, std::span<const size_t> frames) const;

  // Returns the prefilter of an LF image if all `frames` (indices) that need the image need this
  // one. The caller may then filter the image when it is loaded (BatchImage::filtered_by). Returns
  // nothing if no frame needs the image, if frames need different prefilters, or if a frame needs
  // the pixels as loaded.
  std::optional<Prefilter> OnlyPrefilterOf(LfImageId id, std::span<const size_t> frames) const;

  // Returns the CPU seconds that all threads together have spent on collecting rays so far, without
  // the time of OtherItems.
  double cpu_seconds() const { return static_cast<double>(cpu_ns_.load()) * 1e-9; }

 private:
  // The rays that a frame takes: of all LF images, at each of its instants; or, if it has a guard,
  // first of the recorded LF images, and then of all.
  struct Exposure {
    const RenderCamera& camera;
    const ImageWeights& weights;
    PixelReading reading;
  };
  // The contribution of one LF image to one exposure of a frame.
  struct Contribution {
    PixelRect rect;
    ScatterPlan scatter;  // used by kNearest; kBilinear uses `gather`
    GatherPlan gather;
    RayWeights weights;
    // The pixels of the LF image, filtered if `gather` needs it. filtered_ or the batch owns them.
    const LfPixels* pixels = nullptr;
    // BatchImage::Opacity(), filtered likewise; empty if the plate has neither opacity nor a guard.
    const LfPixels* opacity = nullptr;
    LfPixels defocus;  // memory of spare_defocus_, while the contribution is collected
    std::atomic<uint64_t> accepted_count = 0;
  };
  bool is_guarded() const { return !frames_.empty() && frames_.front().guard; }
  size_t exposure_count() const {
    if (frames_.empty()) return 1;
    return 1 + (is_guarded() ? 1 : frames_.front().further.size());
  }
  // Returns the number of the first exposures, which are added to the first channels of the plate.
  size_t instant_count() const { return is_guarded() ? 1 : exposure_count(); }
  Exposure ExposureOf(size_t frame, size_t exposure) const;
  bool PlainlyMisses(const BatchImage& image, size_t frame) const;
  // Returns the contribution of LF image k of a batch of `image_count` LF images.
  Contribution& ContributionOf(size_t taker, size_t exposure, size_t k, size_t image_count) {
    return contributions_[(taker * exposure_count() + exposure) * image_count + k];
  }
  PixelRect RectOf(const BatchImage& image, const RenderCamera& frame) const;
  // The prefilter of the LF image's pixels.
  Prefilter PrefilterOf(const Contribution& contribution) const {
    return reading_.estimator == Estimator::kBilinear ? contribution.gather.sampling.prefilter
                                                      : Prefilter();
  }
  static RayWeights WeightsOf(const Exposure& exposure, LfImageId id) {
    return exposure.weights ? exposure.weights(id) : RayWeights();
  }
  void UndoDistortion(std::vector<BatchImage>& batch);
  std::span<BatchFrame> FramesThatMayTake(const std::vector<BatchImage>& batch,
                                          std::span<BatchFrame> frames);
  size_t CountTogether(const std::vector<BatchImage>& batch,
                       std::span<const BatchFrame> frames) const;
  void FilterImages(std::vector<BatchImage>& batch, size_t frame_count, bool keep_pixels);
  void AddToFrames(std::vector<BatchImage>& batch, std::span<BatchFrame> frames,
                   const OtherItems& other_items, bool keep_pixels,
                   const std::atomic<bool>* interrupted);
  uint64_t AddToTile(const Contribution& contribution, size_t tile, const LfPixels& pixels,
                     TileSums* sums) const;
  void AddByReference(const std::vector<BatchImage>& batch, BatchFrame* frame);
  LfPixels TakeSpareDefocus();
  void PlanContribution(const BatchImage& image, const Exposure& exposure,
                        Contribution* contribution) const;
  void CollectTile(std::span<const BatchImage> batch, size_t taker, size_t frame, size_t number);
  uint64_t CollectByReference(const BatchImage& image, const LfPixels& pixels,
                              const Exposure& exposure, SensorPlate* plate) const;
  uint64_t AddChannelsByReference(const BatchImage& image, const LfPixels& pixels,
                                  const Exposure& exposure, const TileSums::Target& target,
                                  SensorPlate* plate) const;
  // Returns the defocus of the LF image in a guarded frame, not filtered.
  LfPixels DefocusIn(size_t frame, const BatchImage& image, LfPixels memory) const;
  void ForEachTimed(size_t count, const std::function<void(size_t)>& body);

  bool IsVirtual(LfImageId id) const { return light_field_.cameras[id.value].is_virtual; }

  const LightField& light_field_;
  std::span<const CollectedFrame> frames_;
  RayReading reading_;
  CollectBackEnd back_end_;
  size_t plan_bytes_;
  bool whole_images_;
  ThreadPool& pool_;
  std::vector<std::vector<PlateTile>> tiles_;  // [frame]: the tiles of its plate
  // The focal surface of a frame that has most rows of pieces; null: there is none.
  const FocalSurface* largest_surface_ = nullptr;
  // [frame][exposure][LF image] of a batch; the next batch reuses their memory.
  std::deque<Contribution> contributions_;
  std::mutex defocus_mutex_;
  std::vector<LfPixels> spare_defocus_;  // unused memory of Contribution::defocus
  // Ideal pixels of the LF cameras of the last batch, by the index of their intrinsics. Empty with
  // kBilinear or kReference.
  SharedIdealPixels ideal_pixels_;
  std::unique_ptr<FilteredImages> filtered_;
  std::atomic<int64_t> cpu_ns_ = 0;
};

}  // namespace lf
