// Poses as transforms.json writes them: camera-to-world matrices of OpenGL cameras (x right, y up,
// looking along -z).
#pragma once

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

using Mat34 = Eigen::Matrix<double, 3, 4>;

// cam_from_world (x right, y down, z forward) of [s R | c] : R the axes of the OpenGL camera as
// columns, s any scale, c its centre.
//
// An s R that is a rotation to 1e-12 is taken bit for bit; else the nearest rotation to R, since
// files are often written with six digits.
// kInput, without the place: entries that are not finite or beyond 1e12, a determinant of zero or
// below (a mirrored axis), axes that miss right angles or equal lengths by more than 1e-3.
Result<RigidTransform> CamFromWorldOfOpenGl(const Mat34& world_from_opengl_camera);

// The inverse, with s = 1. Rotations come back bit for bit, centres as c = -R^T t, rounded.
Mat34 OpenGlOfCamFromWorld(const RigidTransform& cam_from_world);

}  // namespace lf
