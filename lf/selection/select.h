// Which LF images the frames need, and in what order (thesis 4.2.1).
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/selection/overlap.h"

namespace lf {

// The image order is a shuffle of all LF cameras of the light field by a seed; the *place* of an LF
// image is its rank there, from 0. It does not depend on frames, so that what is counted in places
// (limits, stop rules, how far an interrupted frame has come) means the same for any choice of
// frames and any passes.

// The LF images a frame takes: those at places [begin, end) of the order.
struct PlaceRange {
  uint32_t begin = 0;
  uint32_t end = UINT32_MAX;

  bool Holds(uint32_t place) const { return begin <= place && place < end; }
  friend bool operator==(const PlaceRange&, const PlaceRange&) = default;
};

// One LF image that contributes. Its rectangles per frame are not kept: overlap.h gives them again
// in about a microsecond each, and sooner for frames that it misses.
struct SelectedImage {
  LfImageId id;
  uint32_t place = 0;        // in the order
  PixelRect rect;            // bounds of its rectangles over all frames that take it
  uint32_t frame_count = 0;  // frames that take it
  uint64_t ray_count = 0;    // pixels of all its rectangles: rays to be tested
};

struct SelectOptions {
  uint64_t seed = 0;                    // of the shuffle
  PixelReach reach = PixelReach::kOwn;  // of the estimator
  // Once it is true, the rest is left out and the answer is of no use.
  const std::atomic<bool>* interrupted = nullptr;
};

// All LF images by their places: the shuffle.
std::vector<LfImageId> ImageOrder(size_t image_count, uint64_t seed);

// Tests every LF camera against every frame. The result is in the order of places (thesis: "a more
// even result among all rendered frames, even before all have been processed"), the same for any
// number of threads.
//   places  what each frame takes; empty: every frame takes all
std::vector<SelectedImage> SelectImages(const LightField& light_field,
                                        std::span<const RenderCamera> frames,
                                        const SelectOptions& options, ThreadPool& pool,
                                        std::span<const PlaceRange> places = {});

// For each frame, the places of its first `image_count` contributing LF images: [0, end). A frame
// with fewer takes all places. Looks no further than the frames need.
std::vector<PlaceRange> PlacesOfFirst(size_t image_count, const LightField& light_field,
                                      std::span<const RenderCamera> frames,
                                      const SelectOptions& options, ThreadPool& pool);

}  // namespace lf
