// SPDX-License-Identifier: Apache-2.0
// The sections `camera` and `lens` of a path file (doc/formats/path.md).
#pragma once

#include "lf/camera/path/path_description.h"
#include "lf/camera/path/path_yaml.h"
#include "lf/camera/path/read_quantity.h"
#include "lf/camera/path/yaml_schema.h"

namespace lf {

// These functions set the members of `path` that their section states. They add an error for each
// key that is unknown, is missing, has a wrong type, is out of range, or contradicts another key.
void ReadCameraSection(const YamlNode& node, QuantityReader* quantities, PathDescription* path,
                       YamlErrors* errors);
void ReadLensSection(const YamlNode& node, const ReadTransmission& read_transmission,
                     QuantityReader* quantities, PathDescription* path, YamlErrors* errors);
// PathDescription::unit_m must have been read.
void ReadFocusSection(const YamlNode& node, PathDescription* path, YamlErrors* errors);

}  // namespace lf
