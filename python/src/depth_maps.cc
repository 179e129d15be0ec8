// SPDX-License-Identifier: Apache-2.0
#include "python/src/depth_maps.h"

#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.h"
#include "python/src/errors.h"
#include "python/src/light_field.h"
#include "python/src/work.h"

#include "lf/analysis/depth/depth_map.h"
#include "lf/core/quantities.h"
#include "lf/core/spelling.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/selection/image_index.h"

namespace lf::python {
namespace {

namespace py = pybind11;
using Tell = std::function<void(size_t done, size_t total, int phase)>;

// Returns depths, confidence, filled depths, the sharp picture, the tested distances, the number of
// compared LF images, and name and reason of each broken one.
py::tuple MakeMap(const OpenedField& field, const RenderCamera& camera,
                  std::optional<double> near_w, std::optional<double> far_w, size_t planes,
                  size_t views, int window, double confidence, bool clean, bool strict,
                  const std::string& memory, int threads, const Tell& tell) {
  ThreadPool& pool = PoolOf(threads);
  WorkSignals signals;
  signals.tell = tell;
  DepthMapOptions options;
  options.memory_bytes = Take(ParseByteSize(memory, "memory"));
  options.plane_count = planes;
  options.most_views = views;
  options.window_radius = window / 2;
  options.least_confidence = confidence;
  options.clean = clean;
  options.strict = strict;
  options.stop = &signals.stop;
  DevelopedFrame picture;
  DepthMap map = CallWithoutGil(
      [&] {
        options.range = Take(RangeToSweep(field.light_field, camera, near_w, far_w, pool));
        const ImageIndex index(field.light_field);
        const size_t total = static_cast<size_t>(camera.pinhole.intrinsics.width_px) *
                             static_cast<size_t>(camera.pinhole.intrinsics.height_px);
        DepthMap made = Take(
            MakeDepthMap(index, *field.store, FrameId{1}, camera, options, pool, [&](double share) {
              signals.SetProgress({static_cast<size_t>(share * static_cast<double>(total)), total});
            }));
        picture = DevelopFrame(made.notes, made.sharp, nullptr, false, pool, {}).picture;
        return made;
      },
      &signals);
  std::vector<std::pair<std::string, std::string>> skipped;
  for (const SkippedImage& image : map.skipped)
    skipped.emplace_back(image.name, Spelled(image.reason));
  return py::make_tuple(ArrayOf(std::move(map.depth_w), true),
                        ArrayOf(std::move(map.confidence), true),
                        ArrayOf(std::move(map.filled_w), true), ArrayOf(std::move(picture.rgb)),
                        map.planes_w, map.view_count, skipped);
}

}  // namespace

void AddDepthMaps(py::module_& module) { module.def("depth_map", &MakeMap); }

}  // namespace lf::python
