// SPDX-License-Identifier: Apache-2.0
// Forecasts the cells or kept pixels of the frames of a package, as a render plans and makes them.
// Internal to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/hybrid/rebin_cost.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/render/package/package.h"
#include "lf/selection/image_index.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns the cost of the cells of one pass. Measures it with a few LF images. The options
// of rebinning are the defaults, because packages have none. Errors are those of
// MeasureRebinning().
//   surroundings  [frame number - 1], for all frames of the path
//   frames        the frames of the pass, ascending
//   max_cells     RenderMemory::max_cells
Result<RebinCost> ForecastRebinning(const ImageIndex& index, const LfImageStore& store,
                                    const CameraPath& path,
                                    std::span<const FrameSurroundings> surroundings,
                                    std::span<const FrameId> frames, const NeedsOptions& needs,
                                    const RayReading& reading, size_t max_cells, ThreadPool& pool);

}  // namespace lf
