// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/orientation.h"

namespace lf {

using Eigen::AngleAxisd;

Eigen::Quaterniond WorldFromCam(double yaw_rad, double pitch_rad, double roll_rad) {
  return AngleAxisd(yaw_rad, Vec3::UnitY()) * AngleAxisd(pitch_rad, Vec3::UnitX()) *
         AngleAxisd(roll_rad, Vec3::UnitZ());
}

RigidTransform CamFromWorld(const Eigen::Quaterniond& world_from_cam, const Vec3& centre_world) {
  return RigidTransform{world_from_cam.toRotationMatrix(), centre_world}.Inverse();
}

RigidTransform Rolled(const RigidTransform& cam_from_world, double roll_rad) {
  const Mat3 rolled_from_cam = AngleAxisd(-roll_rad, Vec3::UnitZ()).toRotationMatrix();
  return RigidTransform{rolled_from_cam, Vec3::Zero()} * cam_from_world;
}

}  // namespace lf
