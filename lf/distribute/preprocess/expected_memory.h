// SPDX-License-Identifier: Apache-2.0
// Forecasts the memory of a render. A plan (render/collect/memory_plan.h) promises what is never
// exceeded; most renders take less, because they read few LF images, or only parts of them.
// Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lf/light_field/model/light_field.h"
#include "lf/render/hybrid/rebin_cost.h"
#include "lf/render/hybrid/render_memory.h"

namespace lf {

// LF images that are read.
struct ReadImages {
  size_t count = 0;
  uint64_t pixel_count = 0;  // number of pixels that are read, of all LF images together
};

// Returns the memory of a render, in bytes. It is the memory of the plan with these changes:
// - Two batches hold LF images of the mean size, and no more of them than are read. While rays are
//   collected, five eighths of this are in memory at once.
// - The plans of rays take an eighth of their share.
// - Rebinned rays take what they fill. Frames are interpolated when the LF images are no longer
//   needed, so that the larger of both counts.
// The result is at most plan.total_bytes + rebin_bytes.
//   collects  true if rays are collected; filtered copies of LF images are made only then
//   cost      null: the mode has no rebinned rays
size_t ExpectedBytes(const RenderMemory& memory, const LightField& light_field,
                     const ReadImages& read, bool collects, bool prefilters, const RebinCost* cost);

}  // namespace lf
