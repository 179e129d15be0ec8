// SPDX-License-Identifier: Apache-2.0
// Depth maps for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace lf::python {

void AddDepthMaps(pybind11::module_& module);

}  // namespace lf::python
