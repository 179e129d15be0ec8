// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/read_value.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace lf {
namespace {

using Components = std::optional<std::vector<double>>;

Components ReadNamed(const YamlNode& node, std::string_view label,
                     const std::vector<std::string>& names, const NumberRange& range,
                     YamlErrors* errors) {
  YamlMap map(node, std::string(label), errors);
  std::vector<double> components(names.size(), 0);
  bool complete = node.kind == YamlNode::Kind::kMap;
  for (size_t i = 0; i < names.size(); ++i) {
    const YamlEntry* entry = map.Find(names[i]);
    if (!entry) continue;
    const auto number = ReadNumber(*entry->value, map.Label(names[i]), range, errors);
    if (number) components[i] = *number;
    complete = complete && number.has_value();
  }
  map.CheckKeys();
  if (!complete) return std::nullopt;
  return components;
}

Components ReadQuaternion(const YamlNode& node, std::string_view label, YamlErrors* errors) {
  Components wxyz = ReadNumbers(node, label, 4, NumberRange::Any(), errors);
  if (!wxyz) return std::nullopt;
  const double length = Eigen::Map<const Eigen::Vector4d>(wxyz->data()).norm();
  constexpr double kForgiven = 0.01;
  if (std::abs(length - 1) > kForgiven) {
    errors->Add(node.place,
                fmt::format("{}: expected a rotation [w, x, y, z] of length 1, found length {:.4g}",
                            label, length));
    return std::nullopt;
  }
  for (double& component : *wxyz) component /= length;
  return wxyz;
}

Components ReadComponents(const YamlNode& node, std::string_view label, ValueShape shape,
                          const NumberRange& range, YamlErrors* errors) {
  switch (shape) {
    case ValueShape::kNumber:
      if (const auto number = ReadNumber(node, label, range, errors))
        return std::vector<double>{*number};
      return std::nullopt;
    case ValueShape::kPoint:
      return ReadNumbers(node, label, 3, range, errors);
    case ValueShape::kTilt:
      return ReadNamed(node, label, {"horizontal", "vertical"}, range, errors);
    case ValueShape::kAngles:
      return ReadNamed(node, label, {"yaw", "pitch", "roll"}, range, errors);
    case ValueShape::kQuaternion:
      return ReadQuaternion(node, label, errors);
  }
  return std::nullopt;
}

}  // namespace

int ComponentCount(ValueShape shape) {
  switch (shape) {
    case ValueShape::kNumber:
      return 1;
    case ValueShape::kTilt:
      return 2;
    case ValueShape::kPoint:
    case ValueShape::kAngles:
      return 3;
    case ValueShape::kQuaternion:
      return 4;
  }
  return 0;
}

std::string_view ExampleOf(ValueShape shape) {
  switch (shape) {
    case ValueShape::kNumber:
      return "4";
    case ValueShape::kPoint:
      return "[0, 0, 0.4]";
    case ValueShape::kTilt:
      return "{horizontal: 0, vertical: 30}";
    case ValueShape::kAngles:
      return "{yaw: 0, pitch: 10, roll: 0}";
    case ValueShape::kQuaternion:
      return "[1, 0, 0, 0]";
  }
  return "";
}

std::optional<MotionValue> ReadValue(const YamlNode& node, std::string_view label, ValueShape shape,
                                     const NumberRange& range, double units_per_file,
                                     YamlErrors* errors) {
  const Components components = ReadComponents(node, label, shape, range, errors);
  if (!components) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(components->size());
  const Eigen::Map<const Eigen::VectorXd> in_file_units(components->data(), count);
  return MotionValue(units_per_file * in_file_units);
}

}  // namespace lf
