// SPDX-License-Identifier: Apache-2.0
// Divides the memory of a render (--memory) between rebinned rays, plates and LF images, for each
// render mode.
#pragma once

#include <cstddef>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/collect/memory_plan.h"
#include "lf/render/settings/render_mode.h"

namespace lf {

struct RenderMemory {
  MemoryPlan plan;
  size_t max_cells = 0;    // largest number of cells or kept pixels; 0 if the mode is kCollect
  size_t rebin_bytes = 0;  // memory of these, in addition to plan.total_bytes
  // The least memory_bytes for which all reference images are kept that pay
  // (MemoryPlan::enough_bytes); 0 if no LF image is predicted.
  size_t enough_bytes = 0;
};

// Plans the memory of a render.
//   interpolation   what rays are interpolated between; not kAuto unless the mode is kCollect
//   max_cells       RebinSettings::max_cells; 0: as many as fit in half of the memory (kRebin),
//                   or in a quarter of it (kHybrid)
//   frame_count     number of frames to render. With kRebin, all of them are in one pass.
//   measured_bytes  memory of the noise moments of one frame (collect/noise_moments.h), in addition
//                   to its plate; 0 if noise is not measured. With kRebin, frames have plates only
//                   if this is above 0.
//   instants        number of lenses of each frame
//   references      as for PlanMemory(); in every mode, LF images are read in the film's order
// kOutput: the memory does not suffice for max_cells rebinned rays (at least
// RebinSettings::kLeastCells), for one frame, or, with kRebin and plates, for all frames. The
// message says what takes how much memory.
Result<RenderMemory> PlanRenderMemory(size_t memory_bytes, RenderMode mode,
                                      RayInterpolation interpolation, size_t max_cells,
                                      const LightField& light_field, const RayReading& reading,
                                      int plate_width, int plate_height, size_t frame_count,
                                      int thread_count, size_t measured_bytes = 0,
                                      bool is_guarded = false, size_t instants = 1,
                                      const FocalSurface* surface = nullptr,
                                      const ReferenceNeed& references = {});

}  // namespace lf
