// How fast this machine renders: measured on a few LF images of a frame, for forecasts.
#pragma once

#include <cstddef>

#include "lf/capture/light_field.h"
#include "lf/collector/collect_batch.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/preprocess/frame_needs.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// CPU seconds.
struct RenderRate {
  double load_s = 0;     // for each LF image
  double collect_s = 0;  // for each ray that is tested
  double finish_s = 0;   // for each frame
};

// Loads a few of the images that the frame needs, collects their rays, develops the plate and
// writes it into a temporary folder. kInput: none of them can be loaded; kOutput: it cannot be
// written.
Result<RenderRate> MeasureRate(const LightField& light_field, const RenderCamera& frame,
                               const FrameNeeds& needs, const RayReading& reading,
                               ThreadPool& pool);

}  // namespace lf
