// Selects the LF images that frames need, in their order (thesis 4.2.1).
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

// The LF images that a frame takes: those at places [begin, end) of the order.
struct PlaceRange {
  uint32_t begin = 0;
  uint32_t end = UINT32_MAX;

  bool Holds(uint32_t place) const { return begin <= place && place < end; }
  friend bool operator==(const PlaceRange&, const PlaceRange&) = default;
};

// One LF image that contributes. Its rectangle for each frame is not kept: overlap.h computes it
// again in about a microsecond, and faster for frames that the image misses.
struct SelectedImage {
  LfImageId id;
  uint32_t place = 0;        // in the order
  PixelRect rect;            // bounds of its rectangles over all frames that take it
  uint32_t frame_count = 0;  // frames that take it
  uint64_t ray_count = 0;    // pixels of all its rectangles: rays to be tested
};

struct SelectOptions {
  PixelReach reach = PixelReach::kOwn;  // of the estimator
  // If true, every LF image that may contribute is taken whole, and no rectangle is computed. For
  // measuring the benefit of rectangles.
  bool whole_images = false;
  // If set, LF cameras whose optical axis differs from the frame's by a larger angle are left out,
  // although they may have rays. The thesis leaves out those that look at the render camera; here
  // the user chooses.
  std::optional<double> max_angle_rad = {};
  // Returns false if the frame takes no ray of the LF image although the geometry would allow it,
  // because the image has no lens weight there. Empty: no image is left out. Called by any thread.
  //   frame  index into the frames that LF images are selected for
  std::function<bool(size_t frame, LfImageId id)> takes = {};
  // May be null. Once it is true, the rest is skipped and the result must not be used.
  const std::atomic<bool>* interrupted = nullptr;
};

// Returns true if max_angle_rad does not leave out the LF camera.
bool IsWithinAngle(const LfCamera& lf_camera, const RenderCamera& frame,
                   const SelectOptions& options);

// Returns the LF images that contribute to some frame, in the order of places (thesis: "a more even
// result among all rendered frames, even before all have been processed"). The result does not
// depend on the number of threads.
//   places  of the LF images that each frame takes; empty: every frame takes all
std::vector<SelectedImage> SelectImages(const ImageIndex& index,
                                        std::span<const RenderCamera> frames,
                                        const SelectOptions& options, ThreadPool& pool,
                                        std::span<const PlaceRange> places = {});

// Returns, for each frame, the places [0, end) that hold its first `image_count` contributing LF
// images. A frame with fewer takes all places. An LF image that options.takes leaves out is not
// counted.
std::vector<PlaceRange> PlacesOfFirst(size_t image_count, const ImageIndex& index,
                                      std::span<const RenderCamera> frames,
                                      const SelectOptions& options, ThreadPool& pool);

}  // namespace lf
