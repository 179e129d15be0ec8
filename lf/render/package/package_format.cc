// SPDX-License-Identifier: Apache-2.0
#include "lf/render/package/package_format.h"

#include <array>

#include "lf/camera/intrinsics_numbers.h"
#include "lf/storage/tables/stored_numbers.h"

namespace lf {

std::vector<double> NumbersOfCamera(const RenderCamera& camera) {
  const auto plate = NumbersOfIntrinsics(camera.pinhole.intrinsics);
  const auto pose = NumbersOfPose(camera.pinhole.cam_from_world);
  const Vec3& normal = camera.focus_plane.normal;
  const std::array others = {camera.aperture.radius_w,
                             static_cast<double>(camera.aperture.blades),
                             camera.aperture.rotation_rad,
                             normal.x(),
                             normal.y(),
                             normal.z(),
                             camera.focus_plane.offset_w,
                             camera.time_s,
                             camera.focal_length_w,
                             camera.sensor_width_w,
                             camera.focus_distance_w,
                             camera.focus_tilt.horizontal_rad,
                             camera.focus_tilt.vertical_rad,
                             camera.unit_m};
  static_assert(plate.size() + pose.size() + others.size() == kCameraNumbers);
  std::vector<double> numbers(plate.begin(), plate.end());
  numbers.insert(numbers.end(), pose.begin(), pose.end());
  numbers.insert(numbers.end(), others.begin(), others.end());
  if (HasShape(camera))
    numbers.insert(numbers.end(), {camera.aperture.ratio, camera.aperture.roundness,
                                   camera.hood.distance_w, camera.hood.radius_w});
  return numbers;
}

RenderCamera CameraOfNumbers(std::span<const double> numbers) {
  RenderCamera camera;
  Intrinsics& k = camera.pinhole.intrinsics;
  k.fx_px = numbers[0];
  k.fy_px = numbers[1];
  k.cx_px = numbers[2];
  k.cy_px = numbers[3];
  k.skew_px = numbers[4];
  k.width_px = static_cast<int>(numbers[5]);
  k.height_px = static_cast<int>(numbers[6]);
  camera.pinhole.cam_from_world = PoseOfNumbers(numbers.subspan<7, kPoseNumbers>());
  camera.aperture.radius_w = numbers[19];
  camera.aperture.blades = static_cast<int>(numbers[20]);
  camera.aperture.rotation_rad = numbers[21];
  camera.focus_plane.normal = {numbers[22], numbers[23], numbers[24]};
  camera.focus_plane.offset_w = numbers[25];
  camera.time_s = numbers[26];
  camera.focal_length_w = numbers[27];
  camera.sensor_width_w = numbers[28];
  camera.focus_distance_w = numbers[29];
  camera.focus_tilt.horizontal_rad = numbers[30];
  camera.focus_tilt.vertical_rad = numbers[31];
  camera.unit_m = numbers[32];
  if (numbers.size() > kCameraNumbers) {
    camera.aperture.ratio = numbers[33];
    camera.aperture.roundness = numbers[34];
    camera.hood = {numbers[35], numbers[36]};
  }
  return camera;
}

}  // namespace lf
