// Ray collection over many LF images and frames: images are read once, in order, and every core
// works on any number of frames, even one (doc/design.md, "Work is cut by destination").
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/capture/light_field.h"
#include "lf/collector/collect_batch.h"
#include "lf/collector/image_taker.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/plate/sensor_plate.h"
#include "lf/selection/select.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// Stop rules are decided at multiples of so many places (doc/ray.md, "Same bits").
inline constexpr uint32_t kDecisionPlaces = 64;

struct CollectOptions {
  RayReading reading;
  CollectBackEnd back_end = CollectBackEnd::kFast;
  // The most LF images collected together into a tile of a plate. As many again are decoded
  // meanwhile, so that twice as many are in memory.
  int batch_image_count = 16;
  // Less where a batch would test more rays than this in all frames: some seconds, so that there is
  // progress to tell and a state to write. Or in one frame: less than a second, for those that are
  // begun are finished before an interruption is answered.
  uint64_t batch_ray_count = 10'000'000'000;
  uint64_t batch_frame_ray_count = 500'000'000;
  size_t plan_bytes = size_t{64} << 20;  // of frames whose rays are planned together
  // No batch goes across a multiple of it, in places: there stop rules may be decided, for every
  // frame alike. 0: no rule, batches are not cut. Else a multiple of kDecisionPlaces.
  uint32_t decision_places = kDecisionPlaces;
  // Ends batches at all places where noise is asked for (noise_rule.h), too.
  bool cuts_for_noise = false;
  // Moments of the frames' plates, one per frame, kept with them: those of a frame are of the LF
  // images in its plate. Null: none are kept.
  std::vector<NoiseMoments>* moments = nullptr;
  FrameImageWeights weights;
  // Takes part in all batches beside the frames, if given; the plates are the same.
  ImageTaker* taker = nullptr;
  bool whole_images = false;  // as the order was selected (SelectOptions)
  // All places are below it; 0: they are those of the light field. More of a package.
  uint32_t place_end = 0;
  bool strict = false;                             // a broken LF image is an error
  const std::atomic<bool>* interrupted = nullptr;  // looked at between items of about 10 ms
};

// How far a frame is: of the places it takes, its plate holds the rays of all below places_done,
// and of no other. Broken LF images count as done.
struct FrameProgress {
  uint32_t places_done = 0;
  FrameRays rays;  // that were added by this collector
};

struct SkippedImage {
  std::string name;
  std::string reason;
  uint32_t place = 0;  // in the order
};

struct CollectTimes {
  double load_cpu_s = 0;     // reading and decoding LF images, all threads
  double load_wall_s = 0;    // the same with waiting for the disk, summed over the threads
  double collect_cpu_s = 0;  // planning and adding rays, all threads
  double wall_s = 0;         // of all steps
};

// Adds the rays of LF images, in their order, to plates, one per frame, a batch a step. While a
// batch is collected the next one is decoded, both by the threads of the pool alone.
//
// The plates have the same bits for any order, batch size and number of threads, and however often
// the work was interrupted and taken up again by another object; a broken image that is skipped
// leaves the plates as if it had not been there.
class FrameCollector {
 public:
  // order   LF images that the frames take, by ascending places, each with the bounds of the pixels
  //         that they need: SelectImages() with options.weights as SelectOptions::takes
  // places  what each frame takes: begin is how far its plate is already; empty: every frame all
  // plates  one per frame; only Step() writes them
  // All that is referred to must outlive the collector; `options` and `places` are copied.
  FrameCollector(const LightField& light_field, const LfImageStore& store,
                 std::span<const RenderCamera> frames, std::span<const SelectedImage> order,
                 std::span<const PlaceRange> places, const CollectOptions& options,
                 ThreadPool& pool, std::vector<SensorPlate>* plates);
  ~FrameCollector();
  FrameCollector(const FrameCollector&) = delete;
  FrameCollector& operator=(const FrameCollector&) = delete;

  // Collects the next batch into every frame that is behind its end and not stopped; false when
  // there was nothing left to do. Frames that start at different places catch up.
  // kInterrupted: *options.interrupted became true. Every frame is consistent then: those that were
  //   begun are finished, the others stay at their place. Step() may be called again, and goes on.
  // kInput: a broken image when strict, and kOutput: loading ran out of memory; the plates are as
  //   after the last step, and no further step may follow.
  Result<bool> Step();

  // The frame takes no more images.
  void Stop(size_t frame);

  // As the frames given.
  std::span<const FrameProgress> frames() const;
  // Broken images, by place; of this object's steps only.
  std::span<const SkippedImage> skipped() const;
  // Of the order, how many LF images are in all plates that take them.
  size_t images_done() const;
  const CollectTimes& times() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

struct CollectStatistics {
  std::vector<FrameRays> frames;  // as the frames given
  std::vector<SkippedImage> skipped;
  CollectTimes times;
};

struct CollectProgress {
  size_t image_count = 0;  // places of the order done
  uint64_t tested_count = 0;
};

// All steps of a FrameCollector, from the first place of the order to its end, with its errors.
Result<CollectStatistics> Collect(const LightField& light_field, const LfImageStore& store,
                                  std::span<const RenderCamera> frames,
                                  std::span<const SelectedImage> order,
                                  const CollectOptions& options, ThreadPool& pool,
                                  std::vector<SensorPlate>* plates,
                                  const std::function<void(const CollectProgress&)>& progress);

}  // namespace lf
