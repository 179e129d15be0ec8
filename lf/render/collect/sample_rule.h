// How many rays the elements of a frame have. The rule "samples>=8" stops or refuses a frame by it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/gather_sampling.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/selection/select.h"

namespace lf {

// Returns N of "samples>=N", from 1 to 2^24 - 1. kUsage if the text is no such rule; the message
// names the option.
Result<uint32_t> ParseSampleRule(const std::string& text, const std::string& option);

// A rule is met if this share of the elements that can have rays have N in every channel.
inline constexpr double kMostElements = 0.99;

// The elements that can have rays: an LF image sees their focus point through the lens. Every 8th
// element in both directions is tested, and its answer holds for those around it.
class ReachableElements {
 public:
  static constexpr int kGrid = 8;  // elements

  // places   the places of the index's order whose LF images count
  // filter   used if select.reach is that of bilinear
  // weights  what an LF image counts in the frame; empty: rays through the lens count 1. Rays that
  //          count 0 reach nothing.
  ReachableElements(const ImageIndex& index, const RenderCamera& camera, const PlaceRange& places,
                    const SelectOptions& select, PixelFilter filter, ThreadPool& pool,
                    const std::function<RayWeights(LfImageId)>& weights = {});

  bool Holds(int x, int y) const {
    return is_reachable_[static_cast<size_t>(y / kGrid) * columns_ + x / kGrid] != 0;
  }
  size_t count() const { return count_; }              // elements
  size_t image_count() const { return image_count_; }  // selected LF images at these places

 private:
  size_t columns_ = 0;
  std::vector<uint8_t> is_reachable_;  // [rows][columns] of the grid
  size_t count_ = 0;
  size_t image_count_ = 0;
};

// Returns the number at whose multiples, in places, a frame is asked for its samples: 64 if it
// takes every LF image of a light field, 64 * 2^k if it takes one in 2^k, so that about 64 of its
// own images lie between. The numbers of any two frames divide each other.
uint32_t DecisionPlaces(size_t light_field_image_count, size_t frame_image_count);

// True if kMostElements of the reachable elements have at least `samples` rays in every channel, or
// if none is reachable. Quick if far fewer elements have them.
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
