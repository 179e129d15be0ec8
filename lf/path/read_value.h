// One value of a quantity, as a path file writes it.
#pragma once

#include <optional>
#include <string_view>

#include "lf/path/motion.h"
#include "lf/path/yaml_schema.h"

namespace lf {

enum class ValueShape {
  kNumber,      // 0.4
  kPoint,       // [x, y, z]
  kTilt,        // {horizontal: , vertical: }, 0 if left out
  kAngles,      // {yaw: , pitch: , roll: }, 0 if left out
  kQuaternion,  // [w, x, y, z], length 1
};

// 1 to 4.
int ComponentCount(ValueShape shape);

// A value of that shape as a file writes it, for messages.
std::string_view ExampleOf(ValueShape shape);

// The value times `units_per_file`; none and an error if it is not of that shape, or a component
// is out of range. Quaternions are normalised; 1 % of rounding is forgiven.
std::optional<MotionValue> ReadValue(const YamlNode& node, std::string_view label, ValueShape shape,
                                     const NumberRange& range, double units_per_file,
                                     YamlErrors* errors);

}  // namespace lf
