// How many rays the elements of a frame have, measured so that a frame may stop, or be refused:
// "samples>=8".
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/capture/light_field.h"
#include "lf/collection/gather_sampling.h"
#include "lf/collector/collect_batch.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/plate/sensor_plate.h"
#include "lf/selection/select.h"

namespace lf {

// N of "samples>=N", 1 to 2^24 - 1. kUsage names the option.
Result<uint32_t> ParseSampleRule(const std::string& text, const std::string& option);

// A rule is met when this share of the elements that can have rays do have N, in every channel.
inline constexpr double kMostElements = 0.99;

// Which elements can have rays: those whose focus point is seen by an LF image, through the lens.
// Asked of every 8th element in both directions, which answers for those around it.
class ReachableElements {
 public:
  static constexpr int kGrid = 8;  // elements

  // places  which LF images of the index's order count
  // filter  where select.reach is that of bilinear
  // weights  what an LF image counts in the frame; empty: rays through the lens count 1. Rays that
  //          count 0 reach nothing.
  ReachableElements(const ImageIndex& index, const RenderCamera& camera, const PlaceRange& places,
                    const SelectOptions& select, PixelFilter filter, ThreadPool& pool,
                    const std::function<RayWeights(LfImageId)>& weights = {});

  bool Holds(int x, int y) const {
    return is_reachable_[static_cast<size_t>(y / kGrid) * columns_ + x / kGrid] != 0;
  }
  size_t count() const { return count_; }              // elements
  size_t image_count() const { return image_count_; }  // LF images of these places

 private:
  size_t columns_ = 0;
  std::vector<uint8_t> is_reachable_;  // [rows][columns] of the grid
  size_t count_ = 0;
  size_t image_count_ = 0;
};

// At which multiples of places a frame is asked: 64 where it takes every LF image of a light field,
// 64 * 2^k where it takes one in 2^k, so that about 64 of its own lie between. Those of any two
// frames divide each other.
uint32_t DecisionPlaces(size_t light_field_image_count, size_t frame_image_count);

// Whether kMostElements of the reachable elements have at least `samples` rays in every channel;
// so they have where none is reachable. Quick where it is far from so.
bool HasSamples(const SensorPlate& plate, const ReachableElements& reachable, uint32_t samples);

// The share of reachable elements that have `samples` rays in every channel (1 where none is
// reachable), and the largest number of rays that kMostElements of them have.
struct SampleShare {
  double share = 1;
  uint64_t most_have = 0;
};
SampleShare MeasureSamples(const SensorPlate& plate, const ReachableElements& reachable,
                           uint32_t samples);

}  // namespace lf
