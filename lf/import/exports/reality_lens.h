// SPDX-License-Identifier: Apache-2.0
// The conventions of RealityCapture and RealityScan, which all their exports share. Source: "On the
// Coordinate Systems Employed in the Import, Estimation, and Export of Camera Geometry by
// RealityScan" (Hornacek 2026) and the knowledge base "Registration export and camera
// orientations". Internal to this folder.
#pragma once

#include <array>

#include "lf/camera/distortion.h"
#include "lf/core/geometry.h"

namespace lf {

// Width of a 35 mm film, to which focal lengths refer: f / 36 is the share of the image's larger
// side.
inline constexpr double kFilmWidth_mm = 36;

inline constexpr double kMostRealityCoefficient = 1e6;
// The coefficients k1 k2 k3 k4 t1 t2.
using RealityCoefficients = std::array<double, 6>;

// Returns Brown's distortion with these coefficients:
//   xd = x (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) + t1 (r^2 + 2 x^2) + 2 t2 x y
//   yd = y (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) + t2 (r^2 + 2 y^2) + 2 t1 x y
// t1 and t2 are OpenCV's p2 and p1.
Distortion RealityDistortion(const RealityCoefficients& coefficients);

// Returns the rotation cam_from_world for angles in degrees, in a world with x east, y north and z
// up. They turn an aircraft whose nose points north: yaw about the direction down, clockwise as
// seen from above; then pitch about its right wing, upwards; then roll about its nose, the right
// wing downwards. The camera looks down from it, with the image's upper side towards the nose:
//   world_from_cam = enu_from_ned Rz(yaw) Ry(pitch) Rx(roll) body_from_cam
Mat3 RealityRotation(double yaw_deg, double pitch_deg, double roll_deg);

}  // namespace lf
