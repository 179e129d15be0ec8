#include "python/src/analysis.h"

#include <pybind11/stl.h>

#include <utility>
#include <vector>

#include "python/src/errors.h"
#include "python/src/light_field.h"
#include "python/src/work.h"

#include "lf/analysis/focus_stack/focus_planes.h"

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

}  // namespace

void AddAnalysis(py::module_& module) {
  module.def("even_distances", &EvenDistances);
  module.def("focus_range", &FocusRange);
  module.def("focused_at", [](const RenderCamera& camera, double distance_w) {
    return Take(FocusedAt(camera, distance_w));
  });
}

}  // namespace lf::python
