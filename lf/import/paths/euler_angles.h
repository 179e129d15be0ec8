// SPDX-License-Identifier: Apache-2.0
// Rotations as three angles about the axes, in any order. Internal to this folder.
#pragma once

#include <array>

#include "lf/core/geometry.h"
#include "lf/import/paths/open_path.h"

namespace lf {

// Returns the axes, 0 to 2, in the order in which the rotations about them are applied.
std::array<int, 3> AxesOf(RotationOrder order);

// Returns the rotation by the angles about x, y and z. With kZxy it is R_y R_x R_z.
Mat3 RotationOfAngles(const Vec3& angles_rad, RotationOrder order);

// Returns angles about x, y and z that give the rotation. Among the angles that do, they are those
// nearest to `before_rad`, so that angles of a film do not jump by whole turns.
Vec3 AnglesOfRotation(const Mat3& rotation, RotationOrder order, const Vec3& before_rad);

}  // namespace lf
