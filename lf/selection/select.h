// Which LF images the frames need, and in what order (thesis 4.2.1).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/selection/image_index.h"
#include "lf/selection/overlap.h"

namespace lf {

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
  PixelReach reach = PixelReach::kOwn;  // of the estimator
  // Every LF image that may contribute is taken whole, without looking for rectangles: for
  // measuring what these are worth.
  bool whole_images = false;
  // LF cameras whose optical axes differ more from the frame's are left out, though they may have
  // rays: in the thesis those that look at the render camera, here a choice of the user's. None: no
  // LF camera is.
  std::optional<double> max_angle_rad = {};
  // Returns false if the frame takes no ray of the LF image although the geometry would allow it,
  // because the image has no lens weight there. Empty: no image is left out. Any thread may call
  // it.
  //   frame  index into the frames that are selected for
  std::function<bool(size_t frame, LfImageId id)> takes = {};
  // Once it is true, the rest is left out and the answer is of no use.
  const std::atomic<bool>* interrupted = nullptr;
};

// Whether max_angle_rad lets the LF camera take part.
bool IsWithinAngle(const LfCamera& lf_camera, const RenderCamera& frame,
                   const SelectOptions& options);

// The result is in the order of places (thesis: "a more even result among all rendered frames, even
// before all have been processed"), the same for any number of threads.
//   places  what each frame takes; empty: every frame takes all
std::vector<SelectedImage> SelectImages(const ImageIndex& index,
                                        std::span<const RenderCamera> frames,
                                        const SelectOptions& options, ThreadPool& pool,
                                        std::span<const PlaceRange> places = {});

// For each frame, the places of its first `image_count` contributing LF images: [0, end). A frame
// with fewer takes all places. An LF image that options.takes leaves out is not counted.
std::vector<PlaceRange> PlacesOfFirst(size_t image_count, const ImageIndex& index,
                                      std::span<const RenderCamera> frames,
                                      const SelectOptions& options, ThreadPool& pool);

}  // namespace lf
