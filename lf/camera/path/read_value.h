// SPDX-License-Identifier: Apache-2.0
// Reads one value of a quantity from a path file.
#pragma once

#include <optional>
#include <string_view>

#include "lf/camera/path/motion.h"
#include "lf/camera/path/yaml_schema.h"

namespace lf {

// Shapes of a value in the file, each with the way in which it is written.
enum class ValueShape {
  kNumber,      // 0.4
  kPoint,       // [x, y, z]
  kTilt,        // {horizontal: , vertical: }; an angle that is left out is 0
  kAngles,      // {yaw: , pitch: , roll: }; an angle that is left out is 0
  kQuaternion,  // [w, x, y, z], length 1
};

// Returns the number of components of a value with this shape, 1 to 4.
int ComponentCount(ValueShape shape);

// Returns an example of a value with this shape, as it is written in a file, for messages.
std::string_view ExampleOf(ValueShape shape);

// Returns the value of the node times `units_per_file`. None, with an error, if the node has
// another shape or a component is out of range. Quaternions are normalised; their length may
// deviate from 1 by 1 %.
std::optional<MotionValue> ReadValue(const YamlNode& node, std::string_view label, ValueShape shape,
                                     const NumberRange& range, double units_per_file,
                                     YamlErrors* errors);

}  // namespace lf
