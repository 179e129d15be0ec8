// SPDX-License-Identifier: Apache-2.0
// Focus stacks, epipolar pictures and views as Python sees them: the functions of lf/analysis/.
#pragma once

#include <pybind11/pybind11.h>

namespace lf::python {

void AddAnalysis(pybind11::module_& module);

}  // namespace lf::python
