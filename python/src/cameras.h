// Thin-lens cameras of frames as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

namespace lf::python {

void AddCameras(pybind11::module_& module);

}  // namespace lf::python
