// SPDX-License-Identifier: Apache-2.0
// Comparisons of pictures for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace lf::python {

// Adds the class PictureLight, and functions that compare two of them.
void AddComparisons(pybind11::module_& module);

}  // namespace lf::python
