// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/read_sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lf {
namespace {

constexpr int kMostBlades = 64;
// Width of a full-frame sensor, to which stated focal lengths usually refer.
constexpr double kDefaultSensorWidth_mm = 36;

using enum ValueShape;
using enum QuantityUnit;
const QuantitySpec kPosition{.name = "position", .shape = kPoint, .unit = kLength};
const QuantitySpec kLookAt{.name = "look_at", .shape = kPoint, .unit = kLength};
const QuantitySpec kOrientation{.name = "orientation", .shape = kAngles, .unit = kDegreesUnsaid};
const QuantitySpec kRotation{.name = "quaternion", .shape = kQuaternion};
const QuantitySpec kRoll{.name = "roll", .unit = kDegrees, .zero_if_not_given = true};
const QuantitySpec kFocalLength{
    .name = "focal_length", .unit = kLength, .range = NumberRange::Above(0)};
const QuantitySpec kFieldOfView{
    .name = "field_of_view", .unit = kDegrees, .range = NumberRange::Between(0, 180)};
const QuantitySpec kShift{
    .name = "shift", .shape = kTilt, .unit = kLength, .zero_if_not_given = true};
const QuantitySpec kApertureDiameter{
    .name = "aperture_diameter", .unit = kLength, .range = NumberRange::AtLeast(0)};
const QuantitySpec kFNumber{.name = "f_number", .range = NumberRange::Above(0)};
const QuantitySpec kFocusDistance{
    .name = "focus_distance", .unit = kLength, .range = NumberRange::Above(0)};
const QuantitySpec kFocusPoint{.name = "focus_point", .shape = kPoint, .unit = kLength};
const QuantitySpec kFocusTilt{.name = "focus_tilt",
                              .shape = kTilt,
                              .unit = kDegrees,
                              .range = NumberRange::Between(-90, 90),
                              .zero_if_not_given = true};
const QuantitySpec kBladeRotation{
    .name = "blade_rotation", .unit = kDegrees, .zero_if_not_given = true};

// Adds an error unless exactly one of `choices` is given. If none is given, this is reported only
// if there is no other error, because that error may be the reason.
void RequireOne(const YamlMap& section, const std::vector<const std::optional<Quantity>*>& choices,
                std::string_view what, std::string_view example) {
  const Quantity* first = nullptr;
  for (const std::optional<Quantity>* choice : choices) {
    if (!*choice) continue;
    if (first)
      section.errors()->Add((*choice)->place,
                            fmt::format("{} and {} contradict each other; remove one", first->label,
                                        (*choice)->label));
    first = &**choice;
  }
  if (!first && section.errors()->empty())
    section.errors()->Add(section.place(), fmt::format("{} is missing; write for instance '{}'",
                                                       section.Label(what), example));
}

// Reads `up` and `follow`, which refine look_at and have no meaning with an orientation.
void ReadLookAtKeys(YamlMap* camera, PathDescription* path) {
  YamlErrors* errors = camera->errors();
  const YamlEntry* up = camera->Find("up");
  const YamlEntry* follow = camera->Find("follow");
  for (const YamlEntry* entry : {up, follow})
    if (entry && path->orientation && !path->look_at_w)
      errors->Add(
          entry->place,
          fmt::format("camera.{} is only for look_at; remove it, because the orientation is given",
                      entry->key));
  if (up) {
    const auto xyz = ReadNumbers(*up->value, "camera.up", 3, NumberRange::Any(), errors);
    if (xyz) path->up = Vec3((*xyz)[0], (*xyz)[1], (*xyz)[2]);
    if (path->up.isZero(0)) errors->Add(up->value->place, "camera.up: [0, 0, 0] is no direction");
  }
  if (!follow) return;
  const auto word = ReadWord(*follow->value, "camera.follow", {"look_at", "direction"}, errors);
  path->keep_direction = word == "direction";
  if (path->keep_direction && path->look_at_w && Moves(path->look_at_w->motion))
    errors->Add(follow->place, fmt::format("camera.follow: 'direction' keeps the direction of time "
                                           "0, but {} moves; write 'follow: look_at'",
                                           path->look_at_w->label));
}

void ReadPose(YamlMap* camera, QuantityReader* quantities, PathDescription* path) {
  const std::optional<Quantity> position = quantities->Read(camera, kPosition);
  RequireOne(*camera, {&position}, "position", "position: [0, 0, -0.4]");
  if (position) path->position_w = *position;
  path->look_at_w = quantities->Read(camera, kLookAt);
  path->orientation = quantities->Read(camera, kOrientation);
  const std::optional<Quantity> quaternion = quantities->Read(camera, kRotation);
  RequireOne(*camera, {&path->look_at_w, &path->orientation, &quaternion},
             "look_at (or orientation, quaternion)", "look_at: [0, 0, 0]");
  if (quaternion) path->orientation = quaternion;
  if (const auto roll = quantities->Read(camera, kRoll)) path->roll_rad = *roll;
  ReadLookAtKeys(camera, path);
}

void ReadOptics(YamlMap* camera, QuantityReader* quantities, PathDescription* path) {
  YamlErrors* errors = camera->errors();
  path->sensor_width_w = quantities->ReadFixedLength(camera, "sensor_width", NumberRange::Above(0));
  path->focal_length_w = quantities->Read(camera, kFocalLength);
  path->field_of_view_rad = quantities->Read(camera, kFieldOfView);
  if (const auto shift = quantities->Read(camera, kShift)) path->shift_w = *shift;
  if (path->sensor_width_w && path->focal_length_w && path->field_of_view_rad)
    errors->Add(path->field_of_view_rad->place,
                "sensor width, focal length and field of view are all given, but two of them "
                "determine the third; remove one");
  if (!path->focal_length_w && !path->field_of_view_rad && errors->empty())
    errors->Add(camera->place(),
                "camera.focal_length_mm (or field_of_view_deg) is missing; write for instance "
                "'focal_length_mm: 50'");
  if (!path->sensor_width_w && !(path->focal_length_w && path->field_of_view_rad))
    path->sensor_width_w = kDefaultSensorWidth_mm * 1e-3 / path->unit_m;
}

// Reads a number that does not change over time, unless the key is missing.
void ReadFixedNumber(YamlMap* section, std::string_view key, const NumberRange& range,
                     double* number) {
  if (const YamlEntry* entry = section->Find(key))
    *number =
        ReadNumber(*entry->value, section->Label(key), range, section->errors()).value_or(*number);
}

void ReadShape(YamlMap* lens, QuantityReader* quantities, PathDescription* path) {
  if (const auto rotation = quantities->Read(lens, kBladeRotation))
    path->blade_rotation_rad = *rotation;
  double per_stop_deg = 0;
  ReadFixedNumber(lens, "blade_rotation_per_stop_deg", NumberRange::Any(), &per_stop_deg);
  path->blade_rotation_per_stop_rad = RadiansFromDegrees(per_stop_deg);
  ReadFixedNumber(lens, "ratio", NumberRange::Within(1 / kMostRatio, kMostRatio), &path->ratio);
  ReadFixedNumber(lens, "blade_roundness", NumberRange::Within(0, 1), &path->roundness);
  const YamlEntry* blades = lens->Find("blades");
  if (!blades) return;
  path->blades =
      ReadInteger(*blades->value, "lens.blades", 0, kMostBlades, lens->errors()).value_or(0);
  if (path->blades == 1 || path->blades == 2)
    lens->errors()->Add(blades->value->place,
                        fmt::format("lens.blades: {} blades enclose no opening; write 0 for a "
                                    "circle, or 3 and more",
                                    path->blades));
}

void ReadHood(YamlMap* lens, QuantityReader* quantities, PathDescription* path) {
  const auto distance_w =
      quantities->ReadFixedLength(lens, "hood_distance", NumberRange::AtLeast(0));
  const auto diameter_w = quantities->ReadFixedLength(lens, "hood_diameter", NumberRange::Above(0));
  YamlErrors* errors = lens->errors();
  if (distance_w.has_value() != diameter_w.has_value() && errors->empty())
    errors->Add(lens->place(), "lens.hood_distance and lens.hood_diameter are only given together");
  if (diameter_w && path->blades > kMostBladesInHood)
    errors->Add(lens->place(), fmt::format("lens.blades: {} blades, but a lens with a hood has at "
                                           "most {}",
                                           path->blades, kMostBladesInHood));
  if (distance_w) path->hood_distance_w = *distance_w;
  if (diameter_w) path->hood_diameter_w = *diameter_w;
}

// Reads `transmission`: the name of a picture file, or the text of a transmission. A name has a
// dot, and the text has none.
void ReadTransmissionKey(YamlMap* lens, const ReadTransmission& read_transmission,
                         PathDescription* path) {
  const YamlEntry* entry = lens->Find("transmission");
  if (!entry) return;
  const YamlNode& node = *entry->value;
  if (node.kind != YamlNode::Kind::kPlain && node.kind != YamlNode::Kind::kQuoted) {
    AddExpected(node, "lens.transmission", "the name of a picture file, such as heart.png",
                lens->errors());
    return;
  }
  const bool is_file = node.text.find('.') != std::string::npos;
  const auto read = [&]() -> Result<Transmission> {
    if (!is_file) return Transmission::FromText(node.text);
    if (!read_transmission)
      return InputError(
          "pictures cannot be read here; write the path with lfpath first, which "
          "puts the picture into it");
    return read_transmission(node.text);
  }();
  if (read)
    path->transmission = std::make_shared<const Transmission>(*read);
  else
    lens->errors()->Add(node.place, fmt::format("lens.transmission: {}: {}",
                                                QuoteForMessage(node.text), read.error().message));
}

}  // namespace

void ReadCameraSection(const YamlNode& node, QuantityReader* quantities, PathDescription* path,
                       YamlErrors* errors) {
  YamlMap camera(node, "camera", errors);
  ReadPose(&camera, quantities, path);
  ReadOptics(&camera, quantities, path);
  camera.CheckKeys();
}

void ReadLensSection(const YamlNode& node, const ReadTransmission& read_transmission,
                     QuantityReader* quantities, PathDescription* path, YamlErrors* errors) {
  YamlMap lens(node, "lens", errors);
  path->aperture_diameter_w = quantities->Read(&lens, kApertureDiameter);
  path->f_number = quantities->Read(&lens, kFNumber);
  RequireOne(lens, {&path->aperture_diameter_w, &path->f_number},
             "aperture_diameter_mm (or f_number)", "aperture_diameter_mm: 4");
  path->focus_distance_w = quantities->Read(&lens, kFocusDistance);
  path->focus_point_w = quantities->Read(&lens, kFocusPoint);
  RequireOne(lens, {&path->focus_distance_w, &path->focus_point_w},
             "focus_distance (or focus_point)", "focus_distance: 0.4");
  if (const auto tilt = quantities->Read(&lens, kFocusTilt)) path->focus_tilt_rad = *tilt;
  if (const YamlEntry* breathing = lens.Find("breathing"))
    path->breathing = ReadBool(*breathing->value, "lens.breathing", errors).value_or(false);
  ReadShape(&lens, quantities, path);
  ReadHood(&lens, quantities, path);
  ReadTransmissionKey(&lens, read_transmission, path);
  lens.CheckKeys();
}

}  // namespace lf
