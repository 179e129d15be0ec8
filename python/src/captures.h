// SPDX-License-Identifier: Apache-2.0
// Work on whole captures as Python sees it: reports, forecasts and packages, packed stores, and
// synthetic light fields.
#pragma once

#include <pybind11/pybind11.h>

namespace lf::python {

void AddCaptures(pybind11::module_& module);

}  // namespace lf::python
