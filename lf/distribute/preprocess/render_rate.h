// Measures on a few LF images of a frame how fast this machine renders, for forecasts.
#pragma once

#include <cstddef>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/selection/image_index.h"

namespace lf {

// CPU seconds of the parts of a render.
struct RenderRate {
  double load_s = 0;     // for each LF image
  double collect_s = 0;  // for each ray that is tested
  double finish_s = 0;   // for each frame: its lens weights, developing, writing
};

// Weighs and loads a few of the images that the frame needs, collects their rays, develops the
// plate and writes it into a temporary folder. kInput: none of the images can be loaded; kOutput:
// the frame cannot be written.
Result<RenderRate> MeasureRate(const ImageIndex& index, const RenderCamera& frame,
                               const NeedsOptions& needs, const RayReading& reading,
                               ThreadPool& pool);

}  // namespace lf
