// SPDX-License-Identifier: Apache-2.0
// Poses as transforms.json writes them: camera-to-world matrices of OpenGL cameras (x right, y up,
// looking along -z).
#pragma once

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

using Mat34 = Eigen::Matrix<double, 3, 4>;

// Returns cam_from_world (x right, y down, z forward) of the matrix [s R | c]. The columns of R are
// the axes of the OpenGL camera, s is a scale of at least 1e-6, and c is the camera centre.
//
// If s R is a rotation within 1e-12, it is used bit for bit; otherwise the rotation nearest to R is
// used, because files often have only six digits.
// kInput: numbers that are not finite or beyond +-1e12; a scale below 1e-6; a negative determinant
// (a mirrored axis); axes that deviate from right angles or equal lengths by more than 1e-3. The
// message does not name the place in the file; the caller adds it.
Result<RigidTransform> CamFromWorldOfOpenGl(const Mat34& world_from_opengl_camera);

// Returns the camera-to-world matrix [R | c] of cam_from_world, with scale 1. Rotations are
// preserved bit for bit; the centre c = -R^T t is rounded.
Mat34 OpenGlOfCamFromWorld(const RigidTransform& cam_from_world);

}  // namespace lf
