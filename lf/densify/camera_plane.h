// SPDX-License-Identifier: Apache-2.0
// The positions of all LF cameras of a light field as points of one plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// LF cameras as points of a plane: of the plane parallel to their mean image plane, through their
// mean position. If LF cameras look in directions more than kMostTurn_deg from their mean, like
// those around an object, they are first put on a sphere around the point that they look at, which
// is unrolled: a point's distance and direction from the middle are the length and the direction of
// the arc on the sphere (azimuthal equidistant projection).
struct CameraPlane {
  RigidTransform mean_cam_from_world;  // x along the plane, z normal to it
  std::vector<Vec2> points;            // [camera], in world units: x to the right, y down
  bool is_unrolled = false;            // true: the points were on a sphere
  double widest_deg = 0;  // largest angle between the axis of an LF camera and the mean axis
};
inline constexpr double kMostTurn_deg = 30;
// kInput: LF cameras look in directions too far apart, and do not look at one point from one side.
Result<CameraPlane> CameraPlaneOf(const LightField& light_field);

// Returns the rotation matrix nearest to a weighted sum of rotation matrices.
Mat3 MeanRotation(std::span<const Mat3> rotations, std::span<const double> weights);

}  // namespace lf
