// Orientations of a camera as yaw, pitch and roll.
#pragma once

#include <Eigen/Geometry>

#include "lf/core/geometry.h"

namespace lf {

// world_from_cam = R_y(yaw) R_x(pitch) R_z(roll), right-handed turns about the axes x right, y
// down, z forward. All zero: the camera's axes are the world's. The photographer turns, from there,
//   yaw    to the right, about the world's y axis
//   pitch  up, about the camera's x axis
//   roll   clockwise, about the camera's z axis
Eigen::Quaterniond WorldFromCam(double yaw_rad, double pitch_rad, double roll_rad);

// The pose of a camera at `centre` with that orientation.
RigidTransform CamFromWorld(const Eigen::Quaterniond& world_from_cam, const Vec3& centre_world);

// The pose after a further roll about the optical axis, clockwise for the photographer.
RigidTransform Rolled(const RigidTransform& cam_from_world, double roll_rad);

}  // namespace lf
