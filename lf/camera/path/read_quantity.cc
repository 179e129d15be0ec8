// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/read_quantity.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "lf/camera/path/orientation.h"

namespace lf {
namespace {

constexpr double kLeastKeyDistance_s = 1e-6;
constexpr size_t kMostAccelerations = 1000;  // limited because every frame evaluates all of them

const NumberRange kTimeRange_s = NumberRange::Within(0, NumberRange::kLargest);

// Returns the key of a speed: "speed" for "position", "<name>_speed" for all others.
std::string SpeedName(const std::string& name) {
  return name == "position" ? "speed" : name + "_speed";
}

SmoothCurve CurveOf(ValueShape shape) {
  switch (shape) {
    case ValueShape::kPoint:
      return SmoothCurve::kCatmullRom;
    case ValueShape::kAngles:
    case ValueShape::kQuaternion:
      return SmoothCurve::kRotation;
    case ValueShape::kNumber:
    case ValueShape::kTilt:
      break;
  }
  return SmoothCurve::kMonotone;
}

// Returns the value of a keyframe. Angles become a quaternion, because the rotation between two
// keyframes follows the shorter arc, which needs quaternions (slerp).
MotionValue KeyValue(const MotionValue& value, ValueShape shape) {
  if (shape != ValueShape::kAngles) return value;
  const Eigen::Quaterniond q = WorldFromCam(value[0], value[1], value[2]);
  return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
}

// Returns true if the rotation between two keys is half a turn, so that slerp has no shorter arc.
bool TurnsHalfway(const Key& a, const Key& b, SmoothCurve curve) {
  return curve == SmoothCurve::kRotation && b.interpolation != Interpolation::kStep &&
         std::abs(a.value.dot(b.value)) < 1e-9;
}

Interpolation InterpolationOf(const std::string& word) {
  if (word == "linear") return Interpolation::kLinear;
  if (word == "step") return Interpolation::kStep;
  if (word == "ease") return Interpolation::kEase;
  if (word == "ease_in") return Interpolation::kEaseIn;
  if (word == "ease_out") return Interpolation::kEaseOut;
  return Interpolation::kSmooth;
}

}  // namespace

QuantityReader::QuantityReader(const YamlEntry* keyframes, const YamlEntry* accelerations,
                               double unit_m, YamlErrors* errors)
    : unit_m_(unit_m), errors_(errors), keyframes_("keyframes", errors) {
  if (keyframes) keyframes_ = YamlMap(*keyframes->value, "keyframes", errors);
  if (accelerations) ReadAccelerations(*accelerations->value);
}

void QuantityReader::ReadAccelerations(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kSequence || node.items.size() > kMostAccelerations) {
    errors_->Add(node.place,
                 fmt::format("accelerations: expected a list of up to {} entries such as '- "
                             "{{quantity: position, from: 0, to: 1, value: [0.1, 0, 0]}}'",
                             kMostAccelerations));
    return;
  }
  for (const YamlNodePtr& item : node.items) {
    YamlMap map(*item, "accelerations", errors_);
    const YamlEntry* quantity = map.Require("quantity", "quantity: position");
    const YamlEntry* from = map.Require("from", "from: 0");
    const YamlEntry* to = map.Require("to", "to: 1");
    const YamlEntry* value = map.Require("value", "value: [0.1, 0, 0]");
    map.CheckKeys();
    if (!quantity || !from || !to || !value) continue;
    const auto from_s = ReadNumber(*from->value, map.Label("from"), kTimeRange_s, errors_);
    const auto to_s = ReadNumber(*to->value, map.Label("to"), kTimeRange_s, errors_);
    if (from_s && to_s && !(*to_s > *from_s))
      errors_->Add(to->value->place,
                   fmt::format("accelerations.to: {} s is not after 'from', {} s", *to_s, *from_s));
    accelerations_.push_back({quantity->value->place, quantity->value->text, value->value.get(),
                              from_s.value_or(0), to_s.value_or(1)});
  }
}

std::vector<QuantityReader::UnitEnding> QuantityReader::Endings(QuantityUnit unit) const {
  switch (unit) {
    case QuantityUnit::kLength:
      return {{"", 1}, {"_mm", 1e-3 / unit_m_}};
    case QuantityUnit::kDegrees:
      return {{"_deg", RadiansFromDegrees(1)}};
    case QuantityUnit::kDegreesUnsaid:
      return {{"", RadiansFromDegrees(1)}};
    case QuantityUnit::kNone:
      break;
  }
  return {{"", 1}};
}

QuantityReader::Given QuantityReader::FindInOneUnit(YamlMap* map, const std::string& name,
                                                    QuantityUnit unit) {
  Given given;
  for (const auto& [ending, units_per_file] : Endings(unit)) {
    const YamlEntry* entry = map->Find(name + ending);
    if (entry && given)
      errors_->Add(entry->place, fmt::format("{} and {} state the same quantity; remove one",
                                             given.label, map->Label(entry->key)));
    if (entry) given = {entry, map->Label(entry->key), units_per_file};
  }
  return given;
}

Quantity QuantityReader::Unmoved(const YamlMap& section, const QuantitySpec& spec,
                                 const Given& given) const {
  const UnitEnding unit = Endings(spec.unit).front();
  Quantity quantity;
  quantity.label = given ? given.label : section.Label(spec.name + unit.ending);
  quantity.place = given ? given.entry->place : section.place();
  quantity.range = spec.range;
  quantity.units_per_file = given ? given.units_per_file : unit.units_per_file;
  return quantity;
}

std::optional<Quantity> QuantityReader::Read(YamlMap* section, const QuantitySpec& spec) {
  const Given start = FindInOneUnit(section, spec.name, spec.unit);
  const bool may_accelerate = spec.shape != ValueShape::kQuaternion;
  const Given speed =
      may_accelerate ? FindInOneUnit(section, SpeedName(spec.name), spec.unit) : Given{};
  const Given keyframes = FindInOneUnit(&keyframes_, spec.name, spec.unit);
  YamlPlace place = speed ? speed.entry->place : section->place();
  std::vector<AccelerationPeriod> periods;
  if (may_accelerate) periods = TakePeriods(spec, &place);
  const bool accelerates = speed || !periods.empty();

  if (keyframes && accelerates) {
    errors_->Add(place, fmt::format("{} has keyframes; remove them, or its speed and accelerations",
                                    section->Label(spec.name)));
    return std::nullopt;
  }
  if (accelerates && !start && !spec.zero_if_not_given) {
    errors_->Add(place, fmt::format("{} moves, but its value at time 0 is missing",
                                    section->Label(spec.name)));
    return std::nullopt;
  }
  if (!start && !keyframes && !spec.zero_if_not_given) return std::nullopt;

  Quantity quantity = Unmoved(*section, spec, keyframes ? keyframes : start);
  if (keyframes) {
    auto curve = ReadKeyframes(spec, start, keyframes);
    if (!curve) return std::nullopt;
    quantity.motion = *std::move(curve);
  } else {
    auto motion = ReadAccelerated(spec, start, speed, std::move(periods));
    if (!motion) return std::nullopt;
    quantity.motion = *std::move(motion);
  }
  return quantity;
}

std::optional<double> QuantityReader::ReadFixedLength(YamlMap* section, const std::string& name,
                                                      const NumberRange& range) {
  const Given given = FindInOneUnit(section, name, QuantityUnit::kLength);
  if (!given) return std::nullopt;
  const auto number = ReadNumber(*given.entry->value, given.label, range, errors_);
  if (!number) return std::nullopt;
  return given.units_per_file * *number;
}

std::vector<AccelerationPeriod> QuantityReader::TakePeriods(const QuantitySpec& spec,
                                                            YamlPlace* place) {
  std::vector<AccelerationPeriod> periods;
  for (const auto& [ending, units_per_file] : Endings(spec.unit)) {
    accelerable_.push_back(spec.name + ending);
    for (Acceleration& entry : accelerations_) {
      if (entry.quantity != spec.name + ending) continue;
      entry.read = true;
      *place = entry.place;
      const auto value = ReadValue(*entry.value, "accelerations.value", spec.shape,
                                   NumberRange::Any(), units_per_file, errors_);
      if (value) periods.push_back({entry.from_s, entry.to_s, *value});
    }
  }
  return periods;
}

std::optional<AcceleratedMotion> QuantityReader::ReadAccelerated(
    const QuantitySpec& spec, const Given& start, const Given& speed,
    std::vector<AccelerationPeriod> periods) {
  const MotionValue zero = MotionValue::Zero(ComponentCount(spec.shape));
  const auto read = [&](const Given& given, const NumberRange& range) {
    return given ? ReadValue(*given.entry->value, given.label, spec.shape, range,
                             given.units_per_file, errors_)
                 : zero;
  };
  const std::optional<MotionValue> initial = read(start, spec.range);
  const std::optional<MotionValue> initial_speed = read(speed, NumberRange::Any());
  if (!initial || !initial_speed) return std::nullopt;
  return AcceleratedMotion{*initial, *initial_speed, std::move(periods)};
}

std::optional<KeyframeCurve> QuantityReader::ReadKeyframes(const QuantitySpec& spec,
                                                           const Given& start,
                                                           const Given& keyframes) {
  const YamlNode& node = *keyframes.entry->value;
  if (node.kind != YamlNode::Kind::kSequence || node.items.empty()) {
    errors_->Add(node.place,
                 fmt::format("{}: expected a list of keys such as '- {{time: 0, value: {}}}'",
                             keyframes.label, ExampleOf(spec.shape)));
    return std::nullopt;
  }
  std::vector<Key> keys;
  for (const YamlNodePtr& item : node.items) {
    const std::optional<Key> key = ReadKey(*item, spec, keyframes);
    if (!key) return std::nullopt;
    if (!keys.empty() && key->time_s < keys.back().time_s + kLeastKeyDistance_s) {
      errors_->Add(item->place,
                   fmt::format("{}: the key at {} s must be at least a microsecond later than the "
                               "previous key, at {} s",
                               keyframes.label, key->time_s, keys.back().time_s));
      return std::nullopt;
    }
    keys.push_back(*key);
  }
  if (start && !AddStartAsKey(spec, start, &keys)) return std::nullopt;
  for (size_t i = 1; i < keys.size(); ++i) {
    if (!TurnsHalfway(keys[i - 1], keys[i], CurveOf(spec.shape))) continue;
    errors_->Add(keyframes.entry->place,
                 fmt::format("{}: the rotation to the key at {} s is half a turn, so that its "
                             "direction is ambiguous; add a key in between",
                             keyframes.label, keys[i].time_s));
    return std::nullopt;
  }
  return KeyframeCurve(std::move(keys), CurveOf(spec.shape));
}

std::optional<Key> QuantityReader::ReadKey(const YamlNode& node, const QuantitySpec& spec,
                                           const Given& keyframes) {
  YamlMap map(node, keyframes.label, errors_);
  const YamlEntry* time = map.Require("time", "time: 0");
  const YamlEntry* value = map.Require("value", fmt::format("value: {}", ExampleOf(spec.shape)));
  const YamlEntry* interpolation = map.Find("interpolation");
  map.CheckKeys();
  if (!time || !value) return std::nullopt;
  const auto time_s = ReadNumber(*time->value, map.Label("time"), kTimeRange_s, errors_);
  const auto reached = ReadValue(*value->value, map.Label("value"), spec.shape, spec.range,
                                 keyframes.units_per_file, errors_);
  std::optional<std::string> word = "smooth";
  if (interpolation)
    word = ReadWord(*interpolation->value, map.Label("interpolation"),
                    {"smooth", "linear", "step", "ease", "ease_in", "ease_out"}, errors_);
  if (!time_s || !reached || !word) return std::nullopt;
  return Key{*time_s, KeyValue(*reached, spec.shape), InterpolationOf(*word)};
}

bool QuantityReader::AddStartAsKey(const QuantitySpec& spec, const Given& start,
                                   std::vector<Key>* keys) {
  const auto read = ReadValue(*start.entry->value, start.label, spec.shape, spec.range,
                              start.units_per_file, errors_);
  if (!read) return false;
  const MotionValue value = KeyValue(*read, spec.shape);
  if (keys->front().time_s >= kLeastKeyDistance_s)
    keys->insert(keys->begin(), Key{0, value, Interpolation::kSmooth});
  return true;
}

void QuantityReader::CheckKeys() {
  keyframes_.CheckKeys();
  for (const Acceleration& entry : accelerations_)
    if (!entry.read)
      errors_->AddFirst(entry.place,
                        UnknownWord("quantity", entry.quantity, "accelerations", accelerable_));
}

}  // namespace lf
