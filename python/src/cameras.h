// SPDX-License-Identifier: Apache-2.0
// Thin-lens cameras of frames as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "lf/camera/path/camera_path.h"

namespace lf::python {

// The angle in degrees, number of samples and instants of a shutter; None: there is no shutter.
using ShutterWords = std::optional<std::tuple<double, int, std::vector<RenderCamera>>>;

// Returns a path of these cameras. Their place in the path decides their time.
CameraPath PathOf(std::vector<RenderCamera> cameras, double fps, uint32_t first_frame,
                  double unit_m, ShutterWords shutter);

void AddCameras(pybind11::module_& module);

}  // namespace lf::python
