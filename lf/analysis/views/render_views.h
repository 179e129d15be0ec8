// SPDX-License-Identifier: Apache-2.0
// Makes the views of a grid: where an LF camera stands, of its LF image, elsewhere by rendering.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/analysis/views/view_grid.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct ViewOptions {
  // Depth at which rendered views are sharp. Unset: the middle, in 1 / depth, of the range that
  // FindFocusRange() finds.
  std::optional<double> focus_distance_w = {};
  size_t memory_bytes = size_t{8} << 30;
  bool strict = false;  // true: an LF image that cannot be loaded is an error
  // If not null: once true, the work ends with kInterrupted. `interrupted` must be set with it.
  const std::atomic<bool>* stop = nullptr;
  const std::atomic<bool>* interrupted = nullptr;
};

// Receives a view: linear light [height][width][3], 1 is display white; NaN where no LF image shows
// anything. An error ends the work.
using ViewSink = std::function<Result<void>(size_t view, const Image<float>& light)>;

struct ViewsReport {
  size_t recorded_count = 0;  // number of views that are LF images, resampled or not
  size_t copied_count = 0;    // number of those that are not even resampled
  size_t rendered_count = 0;
  // Focus distance of the rendered views; unset if there are none.
  std::optional<double> focus_distance_w;
  // LF images that were left out because they are missing or broken, each with the reason. A view
  // that is one of them is NaN.
  std::vector<std::string> missing;
  size_t asked_count = 0;  // number of LF images to be loaded, including these
};

// kUsage: the LF images have opacities that must be kept (RadianceEncoding::HasOpacity()), which
// views do not have.
Result<void> CheckForViews(const LightField& light_field);

// Gives each view of the grid to `sink`, one at a time, in any order.
// - A view at the place of a recorded LF camera is its LF image, resampled to the orientation and
//   intrinsics of the view (analysis/rectified/), or unchanged if these agree.
// - Other views are frames of a pinhole: interpolated between the LF images around them, sharp at
//   the focus distance. They are rendered as one film, so that each LF image is read once for all
//   of them that fit into the memory together.
// kUsage as CheckForViews(). kInput: no focus distance is known, but needed; LF images cannot be
// loaded (all of them, or with `strict` one). kOutput: the machine lacks memory. kInterrupted:
// `stop` is set. Other errors are those of `sink` and of FilmSetup::Make().
//   progress  called with the number of views that are done
Result<ViewsReport> MakeViews(const LightField& light_field, const ViewGrid& grid,
                              const ViewOptions& options, ThreadPool& pool, const ViewSink& sink,
                              const std::function<void(size_t done, size_t total)>& progress = {});

}  // namespace lf
