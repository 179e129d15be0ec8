// SPDX-License-Identifier: Apache-2.0
// Divides the memory of a render (--memory) between rebinned rays, plates and LF images, for each
// render mode.
#pragma once

#include <cstddef>
#include <span>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
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
  size_t least_bytes = 0;  // the least memory_bytes that suffices, in whole MiB
};

// The render whose memory is divided.
struct RenderMemoryNeed {
  RenderMode mode = RenderMode::kCollect;
  // Names what rays are interpolated between; not kAuto unless the mode is kCollect.
  RayInterpolation interpolation = RayInterpolation::kAuto;
  // RebinSettings::max_cells. 0: as many cells as fit in half of the memory (kRebin), or in a
  // quarter of it (kHybrid); as many kept pixels, but at most half of what is left beside the least
  // that plates and LF images take.
  size_t max_cells = 0;
  const LightField& light_field;
  const RayReading& reading;
  int plate_width = 0;
  int plate_height = 0;
  size_t frame_count = 1;  // number of frames to render. With kRebin, all of them are in one pass.
  int thread_count = 1;
  // Memory of the noise moments of one frame (collect/noise_moments.h), in addition to its plate; 0
  // if noise is not measured. With kRebin, frames have plates only if this is above 0.
  size_t measured_bytes = 0;
  bool is_guarded = false;
  size_t instants = 1;  // number of lenses of each frame
  const FocalSurface* surface = nullptr;
  // As for PlanMemory(); in every mode, LF images are read in the film's order.
  ReferenceNeed references = {};
};

// Plans the memory of a render. kOutput: the memory does not suffice for max_cells rebinned rays
// (at least RebinSettings::kLeastCells), for one frame, or, with kRebin and plates, for all frames.
// The message says what takes how much memory, and names the least memory that suffices.
Result<RenderMemory> PlanRenderMemory(size_t memory_bytes, const RenderMemoryNeed& need);

// Returns the focal surface with the most rows of pieces; null if there is none.
const FocalSurface* LargestSurface(const CameraPath& path, std::span<const FrameId> frames);

}  // namespace lf
