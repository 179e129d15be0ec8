// SPDX-License-Identifier: Apache-2.0
// Statistics over the lens for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace lf::python {

// Adds the function through(). Frame must be registered before.
void AddLensStatistics(pybind11::module_& module);

}  // namespace lf::python
