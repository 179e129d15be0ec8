// Divides --memory between rebinned rays and collection, in each mode.
#pragma once

#include <cstddef>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/collect/memory_plan.h"
#include "lf/render/hybrid/render_mode.h"

namespace lf {

struct RenderMemory {
  MemoryPlan plan;
  size_t max_cells = 0;    // of rebinned rays; 0 with RenderMode::kCollect
  size_t rebin_bytes = 0;  // memory of these, in addition to plan.total_bytes
};

// Plans the memory of a render.
//   max_cells       RebinPassOptions::max_cells; 0: as many as fit in half of the memory with
//                   kRebin, or in a quarter with kHybrid
//   frame_count     number of frames to render. With kRebin, all are in one pass.
//   measured_bytes  memory for each frame, in addition to its plate, if noise is measured, else 0.
//                   If noise is measured, frames of kRebin have plates.
// kOutput: the memory is less than one frame needs. The message names the memory that is needed.
Result<RenderMemory> PlanRenderMemory(size_t memory_bytes, RenderMode mode, size_t max_cells,
                                      const LightField& light_field, Estimator estimator,
                                      int plate_width, int plate_height, size_t frame_count,
                                      int thread_count, size_t measured_bytes = 0);

}  // namespace lf
