// SPDX-License-Identifier: Apache-2.0
// Measures how fast this machine renders a frame, with a few of the LF images that the frame needs.
// The forecast of lfpreprocessor uses the result.
#pragma once

#include <cstddef>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/selection/image_index.h"

namespace lf {

// CPU times of kept pixels (render/hybrid/frame_pixels.h).
struct KeptRate {
  double keep_s = 0;  // CPU time to choose and keep a pixel that frames ask for
  // CPU time to make such a pixel, and to filter it, for one frame
  double make_s = 0;
};

// CPU times of the parts of a render. The times of rebinned rays are measured for each package
// (render/hybrid/rebin_cost.h).
struct RenderRate {
  double load_s = 0;     // CPU time to load one LF image
  double collect_s = 0;  // CPU time to collect one tested ray
  double finish_s = 0;   // CPU time of lens weights, developing and writing of one frame
  // With kept pixels: if all are kept, and if only those at edges are.
  KeptRate all, edges;
  double gaps_s = 0;  // with kept pixels and kHybrid: CPU time to find the gaps of one frame
};

// Decoded reference images that a render keeps.
struct KeptReferences {
  size_t bytes = 0;        // MemoryPlan::reference_bytes
  bool in_groups = false;  // ReferenceNeed::in_groups
};

// Computes the lens weights of the frame, loads a few of the LF images that the frame needs,
// collects their rays, develops the plate, and writes the picture into the system's temporary
// folder. kInput: none of these LF images can be loaded. kOutput: the picture cannot be written.
//   instant_count  number of lenses of the frame: its lens weights take this many times as long as
//                  those of `frame`
Result<RenderRate> MeasureRate(const ImageIndex& index, const RenderCamera& frame,
                               size_t instant_count, const NeedsOptions& needs,
                               const RayReading& reading, const KeptReferences& kept,
                               ThreadPool& pool);

}  // namespace lf
