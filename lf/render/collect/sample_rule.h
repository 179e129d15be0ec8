// SPDX-License-Identifier: Apache-2.0
// The number of rays that the elements of a frame have, and the rule "samples>=N" (such as
// "samples>=8"): --stop-when stops a frame by it, --require fails if a frame breaks it.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/gather_sampling.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/collect/frame_rays.h"
#include "lf/selection/select.h"

namespace lf {

// The rule is met if at least this share of the reachable elements has N or more rays in every
// channel.
inline constexpr double kMostElements = 0.99;

// The elements that can get recorded rays, because a recorded LF image sees their focus point
// through the lens; virtual ones do not count. In
// each square of kGrid x kGrid elements, only the middle element is tested; the result holds for
// the whole square.
class ReachableElements {
 public:
  static constexpr int kGrid = 8;  // side of a square, in elements

  // ranks   only LF images whose ranks are in this range are considered
  // reading  used only if select.reach is not kOwn, which is the reach of kNearest
  // weights  returns the weights of an LF image in the frame; empty: all rays through the lens have
  //          weight 1. Rays of weight 0 make no element reachable.
  ReachableElements(const ImageIndex& index, const RenderCamera& camera, const RankRange& ranks,
                    const SelectOptions& select, const PixelReading& reading, ThreadPool& pool,
                    const std::function<RayWeights(LfImageId)>& weights = {});

  // Adds the elements that are reachable at another instant of the same frame. image_count()
  // becomes the larger one of both.
  void Join(const ReachableElements& other);

  bool Holds(int x, int y) const {
    return is_reachable_[static_cast<size_t>(y / kGrid) * columns_ + x / kGrid] != 0;
  }
  // Number of reachable elements.
  size_t count() const { return count_; }
  // Number of LF images within `ranks` that selection found for the frame.
  size_t image_count() const { return image_count_; }

 private:
  void CountElements();

  int width_ = 0;
  int height_ = 0;
  size_t columns_ = 0;
  std::vector<uint8_t> is_reachable_;  // [rows][columns] of squares: 1 if reachable, else 0
  size_t count_ = 0;
  size_t image_count_ = 0;
};

// Returns the number of ranks from one application of a frame's rule to the next: 64 if the frame
// takes every LF image of the light field, and 64 * 2^k if it takes one in 2^k, so that the frame
// gets 32 to 64 LF images from one application to the next. The rule is applied at the multiples of
// this number. For any two frames, the larger number is a multiple of the smaller.
uint32_t DecisionRanks(size_t light_field_image_count, size_t frame_image_count);

// Returns true if at least the share kMostElements of the reachable elements has `samples` or more
// rays in every channel, or if no element is reachable. Returns quickly if far fewer elements have
// them.
bool HasSamples(const SensorPlate& plate, const ReachableElements& reachable, uint32_t samples);

SampleShare MeasureSamples(const SensorPlate& plate, const ReachableElements& reachable,
                           uint32_t samples);

}  // namespace lf
