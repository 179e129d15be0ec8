// How fast this machine renders: measured on a few LF images of a frame, for forecasts.
#pragma once

#include <cstddef>

#include "lf/collector/collect_batch.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/preprocess/frame_needs.h"
#include "lf/selection/image_index.h"

namespace lf {

// CPU seconds.
struct RenderRate {
  double load_s = 0;     // for each LF image
  double collect_s = 0;  // for each ray that is tested
  double finish_s = 0;   // for each frame: its lens weights, developing, writing
};

// Weighs and loads a few of the images that the frame needs, collects their rays, develops the
// plate and writes it into a temporary folder. kInput: none of them can be loaded; kOutput: it
// cannot be written.
Result<RenderRate> MeasureRate(const ImageIndex& index, const RenderCamera& frame,
                               const NeedsOptions& needs, const RayReading& reading,
                               ThreadPool& pool);

}  // namespace lf
