// SPDX-License-Identifier: Apache-2.0
#include "python/src/analysis.h"

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.h"
#include "python/src/errors.h"
#include "python/src/gil.h"
#include "python/src/light_field.h"
#include "python/src/work.h"

#include "lf/analysis/epi/epipolar_picture.h"
#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/analysis/views/render_views.h"
#include "lf/core/quantities.h"
#include "lf/core/spelling.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf::python {
namespace {

namespace py = pybind11;

std::vector<double> EvenDistances(double near_w, double far_w, size_t count) {
  return EvenFocusDistances({near_w, far_w}, count);
}

std::pair<double, double> FocusRange(const OpenedField& field, const RenderCamera& camera,
                                     int threads) {
  ThreadPool& pool = PoolOf(threads);
  const DepthRange range =
      CallWithoutGil([&] { return Take(FindFocusRange(field.light_field, camera, pool)); });
  return {range.near_w, range.far_w};
}

// Returns the picture [line][pixel][3], the position and the LF image of each line, how lines are
// made, the focal length in pixels, the direction of the line of LF cameras, the rotation from
// world axes to those of the view, and why LF images were left out.
py::tuple Epi(const OpenedField& field, bool is_row, int pixel, uint32_t through,
              std::optional<double> tolerance_w, std::optional<double> focus_distance_w, int lines,
              std::optional<size_t> count, bool strict, int threads) {
  ThreadPool& pool = PoolOf(threads);
  WorkSignals signals;
  EpipolarOptions options;
  options.kind = is_row ? LineKind::kRow : LineKind::kColumn;
  options.pixel = pixel;
  options.through = LfImageId{through};
  options.tolerance_w = tolerance_w;
  options.focus_distance_w = focus_distance_w;
  options.lines = static_cast<EpipolarLines>(lines);
  options.line_count = count;
  options.strict = strict;
  options.stop = &signals.stop;
  EpipolarPicture picture = CallWithoutGil(
      [&] { return Take(MakeEpipolarPicture(field.light_field, *field.store, options, pool)); },
      &signals);
  std::vector<uint32_t> ids;
  for (const LfImageId id : picture.ids) ids.push_back(id.value);
  std::vector<std::string> reasons(picture.missing.size(), Spelled(picture.first_reason));
  return py::make_tuple(ArrayOf(std::move(picture.light)), picture.positions_w, ids,
                        static_cast<int>(picture.lines), picture.focal_px,
                        picture.line.direction_world, picture.line.rotation, reasons);
}

uint32_t IdOfName(const OpenedField& field, const std::string& name) {
  return Take(LfImageNamed(field.light_field, name)).value;
}

uint32_t MiddleId(const OpenedField& field) {
  const LightField& light_field = field.light_field;
  return MiddleCamera(light_field,
                      [&](LfImageId id) { return !light_field.cameras[id.value].is_virtual; })
      .value;
}

// Returns the size of the views of a grid, and of each view its position, calibration matrix, pose
// [R|t] and LF image (-1: none).
py::tuple DescribeViews(const OpenedField& field, int columns, int rows) {
  const ViewGrid grid =
      CallWithoutGil([&] { return Take(ViewGrid::Make(field.light_field, columns, rows)); });
  py::list views;
  for (size_t view = 0; view < grid.size(); ++view) {
    const PinholeCamera camera = grid.Camera(view);
    Eigen::Matrix<double, 3, 4> pose;
    pose << camera.cam_from_world.rotation, camera.cam_from_world.translation;
    const std::optional<LfImageId> id = grid.RecordedAt(view);
    views.append(py::make_tuple(grid.Position_w(view), camera.intrinsics.Matrix(), pose,
                                id ? static_cast<int64_t>(id->value) : int64_t{-1}));
  }
  return py::make_tuple(grid.height_px(), grid.width_px(), views);
}

// Gives each view to `sink`, as its number and linear light [height][width][3]. Returns the focus
// distance of rendered views, if there are any, and why LF images were left out.
py::tuple MakeViewsFor(const OpenedField& field, int columns, int rows,
                       std::optional<double> focus_distance_w, const std::string& memory,
                       bool strict, int threads, const py::function& sink,
                       const std::function<void(size_t done, size_t total, int phase)>& tell) {
  ThreadPool& pool = PoolOf(threads);
  WorkSignals signals;
  signals.tell = tell;
  ViewOptions options;
  options.focus_distance_w = focus_distance_w;
  options.memory_bytes = Take(ParseByteSize(memory, "memory"));
  options.strict = strict;
  options.stop = &signals.stop;
  options.interrupted = &signals.interrupted;
  std::exception_ptr raised;
  const ViewSink give = [&](size_t view, const Image<float>& light) -> Result<void> {
    const Error ended = {ErrorKind::kInterrupted, "interrupted"};
    const GilHold lock;
    if (!lock.has_lock()) return ended;
    try {
      sink(view, ArrayOf(Image<float>(light)));
    } catch (py::error_already_set&) {
      raised = std::current_exception();
      return ended;
    }
    return {};
  };
  const ViewsReport report = CallWithoutGil(
      [&] {
        const ViewGrid grid = Take(ViewGrid::Make(field.light_field, columns, rows));
        Result<ViewsReport> made =
            MakeViews(field.light_field, grid, options, pool, give, [&](size_t done, size_t total) {
              signals.SetProgress({done, total});
            });
        if (raised) std::rethrow_exception(raised);
        return Take(std::move(made));
      },
      &signals);
  return py::make_tuple(report.focus_distance_w, report.missing);
}

}  // namespace

void AddAnalysis(py::module_& module) {
  module.def("even_distances", &EvenDistances);
  module.def("describe_views", &DescribeViews);
  module.def("epi", &Epi);
  module.def("focus_range", &FocusRange);
  module.def("id_of_name", &IdOfName);
  module.def("make_views", &MakeViewsFor);
  module.def("middle_id", &MiddleId);
  module.def("focused_at", [](const RenderCamera& camera, double distance_w) {
    return Take(FocusedAt(camera, distance_w));
  });
}

}  // namespace lf::python
