// The sections `camera` and `lens` of a path file (doc/formats/path.md).
#pragma once

#include "lf/camera/path/path_description.h"
#include "lf/camera/path/read_quantity.h"
#include "lf/camera/path/yaml_schema.h"

namespace lf {

// Each function fills in its part of the description. It adds an error for a key that is unknown,
// missing, of a wrong type or range, or contradicts another.
void ReadCameraSection(const YamlNode& node, QuantityReader* quantities, PathDescription* path,
                       YamlErrors* errors);
void ReadLensSection(const YamlNode& node, QuantityReader* quantities, PathDescription* path,
                     YamlErrors* errors);

}  // namespace lf
