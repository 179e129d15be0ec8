// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/pinhole.h"

namespace lf {

Mat3 Intrinsics::Matrix() const {
  Mat3 k;
  k << fx_px, skew_px, cx_px,  //
      0, fy_px, cy_px,         //
      0, 0, 1;
  return k;
}

Mat3 Intrinsics::InverseMatrix() const {
  Mat3 k;
  k << 1 / fx_px, -skew_px / (fx_px * fy_px), (skew_px * cy_px / fy_px - cx_px) / fx_px,  //
      0, 1 / fy_px, -cy_px / fy_px,                                                       //
      0, 0, 1;
  return k;
}

std::optional<RigidTransform> LookAlong(const Vec3& centre_world, const Vec3& forward_world,
                                        const Vec3& up_world) {
  const Vec3 right = forward_world.cross(up_world);
  constexpr double kParallel = 1e-12;
  if (!(right.norm() > kParallel * forward_world.norm() * up_world.norm())) return std::nullopt;
  RigidTransform cam_from_world;
  cam_from_world.rotation.row(0) = right.normalized();
  cam_from_world.rotation.row(2) = forward_world.normalized();
  cam_from_world.rotation.row(1) =
      cam_from_world.rotation.row(2).cross(cam_from_world.rotation.row(0));
  cam_from_world.translation = -(cam_from_world.rotation * centre_world);
  return cam_from_world;
}

Ray RayOfPixel(const PinholeCamera& camera, double x_px, double y_px) {
  const Vec3 direction_camera = camera.intrinsics.InverseMatrix() * Vec3(x_px, y_px, 1);
  return {camera.CentreWorld(), camera.cam_from_world.rotation.transpose() * direction_camera};
}

std::optional<Vec2> Project(const PinholeCamera& camera, const Vec3& point_world) {
  const Vec3 point_camera = camera.cam_from_world * point_world;
  if (!(point_camera.z() > 0)) return std::nullopt;
  const Vec3 p = camera.intrinsics.Matrix() * point_camera;
  return Vec2(p.x() / p.z(), p.y() / p.z());
}

}  // namespace lf
