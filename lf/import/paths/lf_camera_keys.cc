// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/lf_camera_keys.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "lf/light_field/model/rotation.h"

namespace lf {
namespace {

constexpr double kAgreement = 1e-6;     // largest deviation from the keys of the format
constexpr double kAlmostZero_w = 1e-9;  // deviation of positions near the origin
constexpr NumberRule kFiniteRule = {"from -1e12 to 1e12",
                                    [](double x) { return std::abs(x) <= 1e12; }};
constexpr NumberRule kLengthRule = {"world units above 0, at most 1e9",
                                    [](double x) { return x > 0 && x <= 1e9; }};
constexpr NumberRule kDiameterRule = {"world units from 0 to 1e9",
                                      [](double x) { return x >= 0 && x <= 1e9; }};
constexpr NumberRule kBladesRule = {"0 or a whole number from 3 to 64", [](double x) {
                                      return x == 0 || (x >= 3 && x <= 64 && x == std::floor(x));
                                    }};
constexpr NumberRule kRatioRule = {"a factor from 0.1 to 10",
                                   [](double x) { return x >= 1 / kMostRatio && x <= kMostRatio; }};
constexpr NumberRule kRoundnessRule = {"a number from 0 to 1",
                                       [](double x) { return x >= 0 && x <= 1; }};
constexpr NumberRule kTiltRule = {"radians above -pi/2, below pi/2",
                                  [](double x) { return std::abs(x) < kPi / 2; }};

using Matrix34Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

Result<void> ReadExactPose(const JsonFields& frame, RigidTransform* cam_from_world) {
  constexpr const char* kKey = "lf_cam_from_world";
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> numbers,
                      frame.Numbers(kKey, 12, 12, kFiniteRule));
  if (!numbers) return {};
  const Matrix34Rows rows(numbers->data());
  const Result<Mat3> rotation = NearestRotation(rows.leftCols<3>(), kAgreement);
  if (!rotation) return frame.Fault(fmt::format("\"{}\" {}", kKey, rotation.error().message));
  const Vec3 translation = rows.col(3);
  const double tolerance_w = kAgreement * translation.norm() + kAlmostZero_w;
  if (!((*rotation - cam_from_world->rotation).cwiseAbs().maxCoeff() <= kAgreement) ||
      !((translation - cam_from_world->translation).norm() <= tolerance_w))
    return frame.Fault(
        fmt::format("\"{}\" is another pose than that of the other keys: remove \"{}\" after "
                    "changing the pose",
                    kKey, kKey));
  *cam_from_world = {*rotation, translation};
  return {};
}

Result<void> ReadExactIntrinsics(const JsonFields& frame, Intrinsics* k) {
  constexpr const char* kKey = kLfIntrinsicsKey;
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> numbers,
                      frame.Numbers(kKey, 5, 5, kFiniteRule));
  if (!numbers) return {};
  const std::vector<double>& n = *numbers;
  if (!(n[0] > 0) || !(std::abs(n[1] - k->fy_px) <= kAgreement * k->fy_px))
    return frame.Wrong(kKey,
                       fmt::format("[fx, fy, cx, cy, skew] with fx above 0 and fy about {} by "
                                   "\"fov\"; remove the key after changing the field of view",
                                   k->fy_px));
  k->fx_px = n[0];
  k->fy_px = n[1];
  k->cx_px = n[2];
  k->cy_px = n[3];
  k->skew_px = n[4];
  return {};
}

Result<void> ReadLength(const JsonFields& frame, const char* key, const NumberRule& rule,
                        std::optional<double>* length_w) {
  LF_ASSIGN_OR_RETURN(const std::optional<double> number, frame.Number(key, rule));
  if (number) *length_w = number;
  return {};
}

}  // namespace

Result<void> ReadLfCameraKeys(const JsonFields& frame, ForeignCamera* camera) {
  LF_RETURN_IF_ERROR(ReadExactPose(frame, &camera->pinhole.cam_from_world));
  LF_RETURN_IF_ERROR(ReadExactIntrinsics(frame, &camera->pinhole.intrinsics));
  LF_RETURN_IF_ERROR(ReadLength(frame, "lf_sensor_width", kLengthRule, &camera->sensor_width_w));
  LF_RETURN_IF_ERROR(ReadLength(frame, "lf_focal_length", kLengthRule, &camera->focal_length_w));
  LF_RETURN_IF_ERROR(
      ReadLength(frame, "lf_aperture_diameter", kDiameterRule, &camera->aperture_diameter_w));
  LF_RETURN_IF_ERROR(
      ReadLength(frame, "lf_focus_distance", kLengthRule, &camera->focus_distance_w));
  LF_ASSIGN_OR_RETURN(const std::optional<double> blades, frame.Number("lf_blades", kBladesRule));
  camera->blades = static_cast<int>(blades.value_or(0));
  LF_ASSIGN_OR_RETURN(const std::optional<double> rotation_rad,
                      frame.Number("lf_blade_rotation_rad", kFiniteRule));
  camera->blade_rotation_rad = rotation_rad.value_or(0);
  LF_ASSIGN_OR_RETURN(const std::optional<double> ratio,
                      frame.Number("lf_aperture_ratio", kRatioRule));
  camera->ratio = ratio.value_or(1);
  LF_ASSIGN_OR_RETURN(const std::optional<double> roundness,
                      frame.Number("lf_blade_roundness", kRoundnessRule));
  camera->roundness = roundness.value_or(0);
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> hood_w,
                      frame.Numbers("lf_hood", 2, 2, kDiameterRule));
  if (hood_w) camera->hood = {(*hood_w)[0], (*hood_w)[1] / 2};
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> tilt_rad,
                      frame.Numbers("lf_focus_tilt_rad", 2, 2, kTiltRule));
  if (tilt_rad) camera->focus_tilt = {(*tilt_rad)[0], (*tilt_rad)[1]};
  return {};
}

void AddLfCameraKeys(const RenderCamera& camera, JsonText* out) {
  const auto add_numbers = [out](const char* key, std::span<const double> numbers) {
    out->Add(", \"{}\": ", key);
    out->AddNumbers(numbers);
  };
  const auto add_number = [out](const char* key, double number) {
    out->Add(", \"{}\": ", key);
    out->AddNumber(number);
  };
  const RigidTransform& pose = camera.pinhole.cam_from_world;
  Matrix34Rows rows;
  rows << pose.rotation, pose.translation;
  const Intrinsics& k = camera.pinhole.intrinsics;
  add_numbers("lf_cam_from_world", {rows.data(), 12});
  add_numbers("lf_intrinsics", std::array{k.fx_px, k.fy_px, k.cx_px, k.cy_px, k.skew_px});
  add_number("lf_sensor_width", camera.sensor_width_w);
  add_number("lf_focal_length", camera.focal_length_w);
  add_number("lf_aperture_diameter", 2 * camera.aperture.radius_w);
  add_number("lf_focus_distance", camera.focus_distance_w);
  if (camera.aperture.blades > 0) out->Add(", \"lf_blades\": {}", camera.aperture.blades);
  if (camera.aperture.rotation_rad != 0)
    add_number("lf_blade_rotation_rad", camera.aperture.rotation_rad);
  if (camera.aperture.ratio != 1) add_number("lf_aperture_ratio", camera.aperture.ratio);
  if (camera.aperture.roundness != 0) add_number("lf_blade_roundness", camera.aperture.roundness);
  if (camera.hood.exists())
    add_numbers("lf_hood", std::array{camera.hood.distance_w, 2 * camera.hood.radius_w});
  const FocusTilt& tilt = camera.focus_tilt;
  if (tilt.horizontal_rad != 0 || tilt.vertical_rad != 0)
    add_numbers("lf_focus_tilt_rad", std::array{tilt.horizontal_rad, tilt.vertical_rad});
}

}  // namespace lf
