// Which LF images the frames need, and in what order (thesis 4.2.1).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/selection/overlap.h"

namespace lf {

// One LF image that contributes. Its rectangles per frame are not kept: overlap.h gives them again
// in about a microsecond each.
struct SelectedImage {
  LfImageId id;
  PixelRect rect;            // bounds of its rectangles over all frames
  uint32_t frame_count = 0;  // frames it contributes to
  uint64_t ray_count = 0;    // pixels of all its rectangles: rays to be tested
};

struct SelectOptions {
  uint64_t seed = 0;                      // of the shuffle
  std::optional<size_t> max_image_count;  // off; the first so many of the order
  PixelReach reach = PixelReach::kOwn;    // of the estimator
};

// Tests every LF camera against every frame. The result is shuffled by `seed` (thesis: "a more
// even result among all rendered frames, even before all have been processed"), the same for any
// number of threads.
std::vector<SelectedImage> SelectImages(const LightField& light_field,
                                        std::span<const RenderCamera> frames,
                                        const SelectOptions& options, ThreadPool& pool);

}  // namespace lf
