// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/camera_facts.h"

#include <cmath>

#include "lf/camera/thin_lens.h"

namespace lf {
namespace {

CameraFact Number(std::string name, double value) { return {std::move(name), {}, {value}}; }

CameraFact Pair(std::string name, std::string first, std::string second, double a, double b) {
  return {std::move(name), {std::move(first), std::move(second)}, {a, b}};
}

CameraFact Vector(std::string name, const Vec3& v) {
  return {std::move(name), {"x", "y", "z"}, {v.x(), v.y(), v.z()}};
}

// Returns the angle under which the plate is seen from the lens centre along one axis.
//   centre_px  principal point
double ViewDeg(int size_px, double centre_px, double focal_length_px) {
  if (2 * centre_px == size_px)
    return DegreesFromRadians(2 * std::atan(size_px / (2 * focal_length_px)));
  return DegreesFromRadians(std::atan(centre_px / focal_length_px) +
                            std::atan((size_px - centre_px) / focal_length_px));
}

}  // namespace

std::vector<CameraFact> CameraFacts(const RenderCamera& camera, FrameId frame) {
  const PinholeCamera& pinhole = camera.pinhole;
  const Intrinsics& k = pinhole.intrinsics;
  const Aperture& aperture = camera.aperture;
  const double diameter_w = 2 * aperture.radius_w;
  const double mm_per_w = 1e3 * camera.unit_m;
  // Width of an element on the focus plane.
  const double element_w = camera.focus_distance_w / k.fx_px;
  const DepthRange depth = DepthOfField(diameter_w, camera.focus_distance_w, element_w);
  const Vec2 shift_mm = mm_per_w * ShiftOf(camera);
  return {
      Number("frame", frame.value),
      Number("time_s", camera.time_s),
      Vector("position_w", pinhole.CentreWorld()),
      Vector("forward", pinhole.ForwardWorld()),
      Vector("up", pinhole.UpWorld()),
      Number("focal_length_mm", mm_per_w * camera.focal_length_w),
      Pair("field_of_view_deg", "horizontal", "vertical", ViewDeg(k.width_px, k.cx_px, k.fx_px),
           ViewDeg(k.height_px, k.cy_px, k.fy_px)),
      Number("aperture_diameter_mm", mm_per_w * diameter_w),
      Number("f_number", FNumber(camera.focal_length_w, diameter_w)),
      Number("blades", aperture.blades),
      Number("blade_rotation_deg", DegreesFromRadians(aperture.rotation_rad)),
      Number("focus_distance_w", camera.focus_distance_w),
      Pair("focus_tilt_deg", "horizontal", "vertical",
           DegreesFromRadians(camera.focus_tilt.horizontal_rad),
           DegreesFromRadians(camera.focus_tilt.vertical_rad)),
      Pair("depth_of_field_w", "near", "far", depth.near_w, depth.far_w),
      Pair("shift_mm", "horizontal", "vertical", shift_mm.x(), shift_mm.y()),
      Number("ratio", aperture.ratio),
      Number("blade_roundness", aperture.roundness),
      Pair("hood_mm", "distance", "diameter", mm_per_w * camera.hood.distance_w,
           mm_per_w * 2 * camera.hood.radius_w),
      Number("transmission", camera.transmission ? camera.transmission->Mean() : 1),
  };
}

}  // namespace lf
