// SPDX-License-Identifier: Apache-2.0
// Orientations of a camera as yaw, pitch and roll.
#pragma once

#include <Eigen/Geometry>

#include "lf/core/geometry.h"

namespace lf {

// Returns world_from_cam = R_y(yaw) R_x(pitch) R_z(roll), right-handed rotations about the axes x
// right, y down, z forward. If all three angles are zero, the camera's axes are the world's. From
// there, the photographer turns
//   yaw    to the right, about the world's y axis
//   pitch  up, about the camera's x axis
//   roll   clockwise, about the camera's z axis
Eigen::Quaterniond WorldFromCam(double yaw_rad, double pitch_rad, double roll_rad);

// Returns the pose of a camera at `centre_world` with the orientation `world_from_cam`.
RigidTransform CamFromWorld(const Eigen::Quaterniond& world_from_cam, const Vec3& centre_world);

// Returns the pose after a further roll about the optical axis, clockwise for the photographer.
RigidTransform Rolled(const RigidTransform& cam_from_world, double roll_rad);

}  // namespace lf
