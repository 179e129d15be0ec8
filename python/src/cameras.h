// Thin-lens cameras of frames as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "lf/camera/path/camera_path.h"

namespace lf::python {

// Returns a path of these cameras. Their place in the path decides their time.
CameraPath PathOf(std::vector<RenderCamera> cameras, double fps, double unit_m);

void AddCameras(pybind11::module_& module);

}  // namespace lf::python
