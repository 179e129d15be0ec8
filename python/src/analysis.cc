#include "python/src/analysis.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.h"
#include "python/src/errors.h"
#include "python/src/light_field.h"
#include "python/src/work.h"

#include "lf/analysis/epi/epipolar_picture.h"
#include "lf/analysis/focus_stack/focus_planes.h"
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
  std::vector<std::string> reasons(picture.missing.size(), picture.first_reason);
  return py::make_tuple(ArrayOf(std::move(picture.light)), picture.positions_w, ids,
                        static_cast<int>(picture.lines), picture.focal_px,
                        picture.line.direction_world, picture.line.rotation, reasons);
}

uint32_t IdOfName(const OpenedField& field, const std::string& name) {
  return Take(LfImageNamed(field.light_field, name)).value;
}

uint32_t MiddleId(const OpenedField& field) { return MiddleCamera(field.light_field).value; }

}  // namespace

void AddAnalysis(py::module_& module) {
  module.def("even_distances", &EvenDistances);
  module.def("epi", &Epi);
  module.def("focus_range", &FocusRange);
  module.def("id_of_name", &IdOfName);
  module.def("middle_id", &MiddleId);
  module.def("focused_at", [](const RenderCamera& camera, double distance_w) {
    return Take(FocusedAt(camera, distance_w));
  });
}

}  // namespace lf::python
