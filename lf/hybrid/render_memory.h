// Shares of --memory in each mode: for rebinned rays, and for collection beside them.
#pragma once

#include <cstddef>

#include "lf/capture/light_field.h"
#include "lf/collector/collect_batch.h"
#include "lf/collector/memory_plan.h"
#include "lf/core/result.h"
#include "lf/hybrid/render_mode.h"

namespace lf {

struct RenderMemory {
  MemoryPlan plan;
  size_t max_cells = 0;    // of rebinned rays; 0 with RenderMode::kCollect
  size_t rebin_bytes = 0;  // that these take, beside plan.total_bytes
};

//   max_cells    RebinPassOptions::max_cells; 0: as many as fit in half of the memory with kRebin,
//                or a quarter with kHybrid
//   frame_count  that are to be rendered. With kRebin all are in one pass.
//   measured_bytes  kept beside the plate of each frame where noise is measured: then frames of
//                   kRebin have plates, too; 0: it is not
// kOutput: less memory than one frame needs; the message names the least that is.
Result<RenderMemory> PlanRenderMemory(size_t memory_bytes, RenderMode mode, size_t max_cells,
                                      const LightField& light_field, Estimator estimator,
                                      int plate_width, int plate_height, size_t frame_count,
                                      int thread_count, size_t measured_bytes = 0);

}  // namespace lf
