// SPDX-License-Identifier: Apache-2.0
// Collects the rays of many LF images into the plates of many frames. Each LF image is read once,
// by ascending ranks in the order (selection/image_order.h). All CPU cores work together, even if
// there is only one frame (doc/design.md, "Work is cut by destination").
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/collect/collected_frame.h"
#include "lf/render/collect/frame_rays.h"
#include "lf/render/collect/image_consumer.h"
#include "lf/selection/select.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// The rule "samples>=N" (sample_rule.h) may stop a frame only at ranks that are multiples of this
// number (doc/ray.md, "Same bits"). The rule "noise<=X" may stop it at the ranks of
// NoiseDecisionAfter() (noise_rule.h).
inline constexpr uint32_t kDecisionRanks = 64;

struct CollectOptions {
  RayReading reading;
  CollectBackEnd back_end = CollectBackEnd::kFast;
  // Largest number of LF images in a batch. A thread adds all LF images of a batch to one tile of a
  // plate before it takes another tile. The next batch is decoded at the same time, so that twice
  // this number of LF images is in memory.
  int batch_image_count = 16;
  // Largest number of rays that a batch of two or more LF images tests. batch_ray_count limits the
  // rays in all frames together to some seconds of work, so that progress is reported and
  // checkpoints are written between two batches. batch_frame_ray_count limits the rays in a frame
  // (the mean of the frames that take an LF image) to less than a second of work, because an
  // interruption waits until each plate that has a part of the batch has all of it.
  uint64_t batch_ray_count = 10'000'000'000;
  uint64_t batch_frame_ray_count = 500'000'000;
  size_t plan_bytes = size_t{64} << 20;  // memory for the plans (PlanBytes()) of a batch's rays
  // No batch extends beyond a rank that is a multiple of this number, so that stop rules may be
  // applied there. Must be 0 or a multiple of kDecisionRanks. 0: batches do not end for this
  // reason.
  uint32_t decision_ranks = kDecisionRanks;
  // True: batches also end at all ranks of NoiseDecisionAfter() (noise_rule.h).
  bool cuts_for_noise = false;
  // Receives the LF images from its ranks_done() on, in addition to the frames. The plates are the
  // same with and without a consumer. Null: there is none.
  ImageConsumer* consumer = nullptr;
  bool whole_images = false;  // must be equal to SelectOptions::whole_images of the selection
  // End (exclusive) of all ranks in the order. 0: the number of LF images in the light field. Must
  // be set for a package, because its ranks are those of the whole light field.
  uint32_t rank_end = 0;
  bool strict = false;  // true: a broken LF image is an error; false: it is skipped
  // Once it is true, Step() returns kInterrupted, unless no work is left. Null: nothing interrupts.
  const std::atomic<bool>* interrupted = nullptr;
};

struct CollectTimes {
  double load_cpu_s = 0;  // CPU time to read and decode LF images, sum of all threads
  // Elapsed time to read and decode LF images, with waits for the disk, sum of all threads.
  double load_wall_s = 0;
  double collect_cpu_s = 0;  // CPU time to plan and add rays, sum of all threads
  double wall_s = 0;         // duration of all steps
};

// Adds the rays of LF images, in their order, to the plates of frames. Each step adds a batch of
// LF images while the next batch is decoded. The threads of the pool do both.
//
// The plates have the same bits for any order, batch size and number of threads, and however often
// the work was interrupted and resumed by another object. An LF image that is skipped because it is
// broken leaves the plates as if the light field did not contain it.
class FrameCollector {
 public:
  // order   LF images that the frames take, by ascending ranks, each with the bounds of the pixels
  //         that the frames need: the result of SelectImages(), where TakingFrame::takes must be
  //         true exactly for the LF images to which CollectedFrame::weights gives a weight above 0.
  //         Also those that only options.consumer needs, with an empty `rect`
  // All arguments except `frames` and `options`, and all objects that these two point to, must
  // outlive the collector. Only Step() changes plates and moments.
  FrameCollector(const LightField& light_field, const LfImageStore& store,
                 std::vector<CollectedFrame> frames, std::span<const SelectedImage> order,
                 const CollectOptions& options, ThreadPool& pool);
  ~FrameCollector();
  FrameCollector(const FrameCollector&) = delete;
  FrameCollector& operator=(const FrameCollector&) = delete;

  // Collects the next batch into every frame that has not reached its ranks.end and is not
  // stopped. Returns false if nothing was left to do. If frames start at different ranks, those
  // that are behind catch up first.
  // kInterrupted: *options.interrupted became true. Every frame is consistent: it has either all LF
  // images of the batch or none. Step() may be called again to continue.
  // kInput: an LF image is broken and `strict` is set, or an LF image that was read before has
  // vanished. kOutput: loading needs something that the machine lacks, such as memory. After either
  // of these two errors, the plates are as after the last successful step, and Step() must not be
  // called again.
  Result<bool> Step();

  // Stops a frame, given by its index in frames(): it takes no more LF images.
  void Stop(size_t frame);

  // The constructor's `frames`, with their progress.
  std::span<const CollectedFrame> frames() const;
  // Broken LF images that this object skipped, by ascending ranks.
  std::span<const SkippedImage> skipped() const;
  // Number of LF images at the beginning of `order` that no frame and no consumer needs any more.
  size_t images_done() const;
  const CollectTimes& times() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

struct CollectStatistics {
  std::vector<FrameRays> frames;  // ray counts of each frame, in the order of `frames`
  std::vector<SkippedImage> skipped;
  CollectTimes times;
};

struct CollectProgress {
  size_t image_count = 0;     // number of LF images of `order` that are done
  uint64_t tested_count = 0;  // sum of SelectedImage::ray_count of these LF images
};

// Makes a FrameCollector and calls Step() until nothing is left to do. Errors are
// those of FrameCollector::Step().
Result<CollectStatistics> Collect(const LightField& light_field, const LfImageStore& store,
                                  std::vector<CollectedFrame> frames,
                                  std::span<const SelectedImage> order,
                                  const CollectOptions& options, ThreadPool& pool,
                                  const std::function<void(const CollectProgress&)>& progress);

}  // namespace lf
