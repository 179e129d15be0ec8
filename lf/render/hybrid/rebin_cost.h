// SPDX-License-Identifier: Apache-2.0
// Forecasts the CPU time and the memory of the rebinned rays of a pass (rebinned_rays.h). The
// number of LF pixels that become rays follows from the calibration. The time to rebin them, the
// number of cells that they fill, and the time to interpolate frames from these cells are measured
// with a few LF images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/hybrid/film_slabs.h"
#include "lf/render/hybrid/rebinned_rays.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns the CPU time of all threads of this process so far. Differences are the times of a step
// if nothing else runs in the process.
double ProcessCpuSeconds();

// CPU times of the rebinned rays of a pass.
struct RebinCost {
  double begin_s = 0;        // planning which rays are kept
  double rebin_s = 0;        // sorting LF pixels into cells
  double complete_s = 0;     // interpolating all frames
  uint64_t pixel_count = 0;  // number of LF pixels that are sorted into cells
  size_t cell_count = 0;
  size_t map_bytes = 0;    // memory of the cells
  size_t frame_bytes = 0;  // memory of the rays of one frame, which are made from the cells
};

// Times and counts that were measured with a few LF images of a pass. CostOf() scales them to all
// LF images, frames and cells.
struct RebinSample {
  uint64_t pixel_count = 0;  // number of LF pixels that were sorted into cells
  size_t cell_count = 0;     // number of cells that they filled
  double rebin_s = 0;        // CPU time to sort them
  double find_s = 0;         // CPU time to find the pixels of one LF image that become rays
  double sort_s = 0;         // CPU time to sort the cells
  double empty_s = 0;        // CPU time to interpolate one frame from no cells
  double complete_s = 0;     // CPU time to interpolate one frame from the sorted cells
};

// Number of frames and LF pixels of a section (RebinnedRays::section_count()).
struct RebinSection {
  size_t frame_count = 0;  // number of frames that need rebinned rays when they are finished
  double pixel_count = 0;  // expected number of LF pixels that become rays
};

// Returns the cost of a pass, with 0 for begin_s. A stage costs as much for each LF pixel, LF
// image, cell or frame as in the sample. Each frame is interpolated from all cells of its section.
//   image_count  number of LF images that are rebinned
//   max_cells    largest number of cells of a section
//   expected     [section]: number of cells for which memory is allocated at once
RebinCost CostOf(const RebinSample& sample, std::span<const RebinSection> sections,
                 size_t image_count, size_t max_cells, std::span<const size_t> expected);

// Returns the cost of a pass. Loads up to `most` LF images that the frames need, and rebins them.
//   collects  true if the frames also collect rays
//   begin_s   CPU time that the caller has taken to make `frames` and `slabs`
// Errors are those of Collect(), except that missing LF images are left out.
Result<RebinCost> MeasureRebinning(const ImageIndex& index, const LfImageStore& store,
                                   const FilmSlabs& slabs, std::vector<RebinnedFrame> frames,
                                   bool collects, const SelectOptions& select,
                                   RebinSettings options, const RayReading& reading, double begin_s,
                                   size_t most, ThreadPool& pool);

}  // namespace lf
