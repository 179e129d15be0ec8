// Ray collection over many LF images and frames: images are read once, in order, and all cores work
// on any number of frames, even on one (doc/design.md, "Work is cut by destination").
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
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/collect/image_consumer.h"
#include "lf/selection/select.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Stop rules are decided at multiples of this number of places (doc/ray.md, "Same bits").
inline constexpr uint32_t kDecisionPlaces = 64;

struct CollectOptions {
  RayReading reading;
  CollectBackEnd back_end = CollectBackEnd::kFast;
  // Largest number of LF images that are collected together into a tile of a plate. As many again
  // are decoded meanwhile, so that twice as many are in memory.
  int batch_image_count = 16;
  // Largest number of rays that a batch of more than one image tests. In all frames: some seconds
  // of work, so that progress can be reported and a state written. In one frame: less than a
  // second, because frames that are begun are finished before an interruption is answered.
  uint64_t batch_ray_count = 10'000'000'000;
  uint64_t batch_frame_ray_count = 500'000'000;
  size_t plan_bytes = size_t{64} << 20;  // memory for frames that are planned together
  // No batch crosses a multiple of this number of places, where stop rules may be decided for all
  // frames. 0: there is no rule, and batches are not cut. Otherwise a multiple of kDecisionPlaces.
  uint32_t decision_places = kDecisionPlaces;
  // Also ends batches at all places where noise is asked for (noise_rule.h).
  bool cuts_for_noise = false;
  // Moments of the frames' plates, one per frame. They are kept together with the plates: the
  // moments of a frame cover exactly the LF images in its plate. Null: none are kept.
  std::vector<NoiseMoments>* moments = nullptr;
  FrameImageWeights weights;
  // Takes part in all batches beside the frames, if given. It does not change the plates.
  ImageConsumer* consumer = nullptr;
  bool whole_images = false;  // must be as in the SelectOptions of the order
  // End of all places. 0: the number of LF images in the light field; a package, whose places are
  // those of the whole light field, needs more.
  uint32_t place_end = 0;
  bool strict = false;                             // a broken LF image is an error
  const std::atomic<bool>* interrupted = nullptr;  // checked between items of about 10 ms
};

// Progress of a frame: its plate holds the rays of all places below places_done that the frame
// takes, and of no others. Broken LF images count as done.
struct FrameProgress {
  uint32_t places_done = 0;
  FrameRays rays;  // rays that this collector added
};

struct SkippedImage {
  std::string name;
  std::string reason;
  uint32_t place = 0;  // in the order
};

struct CollectTimes {
  double load_cpu_s = 0;     // reading and decoding LF images, all threads
  double load_wall_s = 0;    // as load_cpu_s, with waiting for the disk; summed over the threads
  double collect_cpu_s = 0;  // planning and adding rays, all threads
  double wall_s = 0;         // all steps
};

// Adds the rays of LF images, in their order, to plates, one per frame. Each step adds a batch,
// while the next one is decoded; the threads of the pool do both.
//
// The plates have the same bits for any order, batch size and number of threads, and however often
// the work was interrupted and resumed by another object. A broken image that is skipped leaves the
// plates as if it had not been there.
class FrameCollector {
 public:
  // order   LF images that the frames take, by ascending places, each with the bounds of the pixels
  //         that they need: SelectImages() with options.weights as SelectOptions::takes
  // places  the places that each frame takes; begin is what its plate has already. Empty: all
  // plates  one per frame; only Step() writes them
  // Everything that is referred to must outlive the collector; `options` and `places` are copied.
  FrameCollector(const LightField& light_field, const LfImageStore& store,
                 std::span<const RenderCamera> frames, std::span<const SelectedImage> order,
                 std::span<const PlaceRange> places, const CollectOptions& options,
                 ThreadPool& pool, std::vector<SensorPlate>* plates);
  ~FrameCollector();
  FrameCollector(const FrameCollector&) = delete;
  FrameCollector& operator=(const FrameCollector&) = delete;

  // Collects the next batch into every frame that has not reached its end and is not stopped.
  // Returns false if nothing was left to do. Frames that start at different places catch up.
  // kInterrupted: *options.interrupted became true. Every frame is consistent: those that were
  //   begun are finished, the others stay at their place. Step() may be called again to continue.
  // kInput: an image is broken and `strict` is set, or all images are gone. kOutput: the machine
  //   lacks something that loading needs, such as memory. The plates are as after the last step,
  //   and no further step may follow.
  Result<bool> Step();

  // Stops a frame, which takes no more images.
  void Stop(size_t frame);

  // Progress of each frame, in the order of the frames given.
  std::span<const FrameProgress> frames() const;
  // Broken images that the steps of this object skipped, by place.
  std::span<const SkippedImage> skipped() const;
  // Number of LF images of the order that are in all plates that take them.
  size_t images_done() const;
  const CollectTimes& times() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

struct CollectStatistics {
  std::vector<FrameRays> frames;  // in the order of the frames given
  std::vector<SkippedImage> skipped;
  CollectTimes times;
};

struct CollectProgress {
  size_t image_count = 0;  // LF images of the order that are done
  uint64_t tested_count = 0;
};

// Takes all steps of a FrameCollector, from the first place of the order to its end. Returns its
// errors.
Result<CollectStatistics> Collect(const LightField& light_field, const LfImageStore& store,
                                  std::span<const RenderCamera> frames,
                                  std::span<const SelectedImage> order,
                                  const CollectOptions& options, ThreadPool& pool,
                                  std::vector<SensorPlate>* plates,
                                  const std::function<void(const CollectProgress&)>& progress);

}  // namespace lf
