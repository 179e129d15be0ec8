// SPDX-License-Identifier: Apache-2.0
// Films in memory as Python sees them: the renderer of film_renderer.h.
#pragma once

#include <pybind11/pybind11.h>

namespace lf::python {

void AddFilm(pybind11::module_& module);

}  // namespace lf::python
