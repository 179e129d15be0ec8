// SPDX-License-Identifier: Apache-2.0
// The light field as Python sees it.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf::python {

// An open light field.
struct OpenedField {
  LightField light_field;
  std::unique_ptr<LfImageStore> store;  // loads mosaics as RGB
  std::vector<std::string> options;     // options of LIGHTFIELD, as words of a command line
};

void AddLightField(pybind11::module_& module);

}  // namespace lf::python
