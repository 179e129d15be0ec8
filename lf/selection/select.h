// SPDX-License-Identifier: Apache-2.0
// Selects the LF images that frames need, by ascending ranks (thesis 4.2.1).
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

// A range [begin, end) of ranks of LF images in the order (image_order.h).
struct RankRange {
  uint32_t begin = 0;
  uint32_t end = UINT32_MAX;

  bool Holds(uint32_t rank) const { return begin <= rank && rank < end; }
  friend bool operator==(const RankRange&, const RankRange&) = default;
};

// A frame for which LF images are selected.
struct TakingFrame {
  RenderCamera camera;
  RankRange ranks = {};  // the frame takes only the LF images at these ranks
  // Returns false if the frame does not take an LF image, because all lens weights of the image in
  // this frame are 0. Empty: no LF image is left out for this reason. Several threads call it at
  // the same time.
  std::function<bool(LfImageId id)> takes = {};
};

// One LF image that contributes to at least one frame. Its rectangle for each single frame is not
// stored, because overlap.h computes it again in about a microsecond, or faster if the LF image
// misses the frame.
struct SelectedImage {
  LfImageId id;
  uint32_t rank = 0;         // rank of the LF image in the order (image_order.h)
  PixelRect rect;            // bounds of its rectangles for all frames that take it
  uint32_t frame_count = 0;  // number of frames that take it
  uint64_t ray_count = 0;    // sum of the pixel counts of these rectangles: rays to be tested
};

struct SelectOptions {
  PixelReach reach = PixelReach::kOwn;  // which pixels the estimator needs
  // If true, the rectangle of every LF image that may contribute is the whole image. Serves to
  // measure the benefit of rectangles.
  bool whole_images = false;
  // If set, an LF camera is left out if the angle between its optical axis and the frame's is
  // larger than this, even if it has rays for the frame. (The thesis leaves out LF cameras that
  // look at the render camera. Here the user chooses the angle.)
  std::optional<double> max_angle_rad = {};
  // If it is not null and becomes true, the remaining work is skipped and the result must not be
  // used.
  const std::atomic<bool>* interrupted = nullptr;
};

// Returns true if options.max_angle_rad is unset or does not leave out the LF camera.
bool IsWithinAngle(const LfCamera& lf_camera, const RenderCamera& frame,
                   const SelectOptions& options);

// Returns the LF images that contribute to at least one frame, by ascending ranks (thesis: "a more
// even result among all rendered frames, even before all have been processed"). The result does not
// depend on the number of threads.
std::vector<SelectedImage> SelectImages(const ImageIndex& index,
                                        std::span<const TakingFrame> frames,
                                        const SelectOptions& options, ThreadPool& pool);
// Selects LF images for frames that take every LF image that contributes to them.
std::vector<SelectedImage> SelectImages(const ImageIndex& index,
                                        std::span<const RenderCamera> frames,
                                        const SelectOptions& options, ThreadPool& pool);

// Returns the range [0, end) of ranks that contains exactly the first `image_count` contributing
// LF images that the frame takes. If there are fewer, the range is all ranks. image_count must be
// above 0. frame.ranks and options.whole_images are not used. The second form counts an LF image
// that contributes to at least one of the instants of a frame once.
RankRange RanksOfFirst(size_t image_count, const ImageIndex& index, const TakingFrame& frame,
                       const SelectOptions& options);
RankRange RanksOfFirst(size_t image_count, const ImageIndex& index,
                       std::span<const TakingFrame> instants, const SelectOptions& options);

}  // namespace lf
