// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/opengl_pose.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "lf/light_field/model/rotation.h"

namespace lf {
namespace {

constexpr double kLargest = 1e12;        // largest absolute value of a number in a matrix
constexpr double kSmallestScale = 1e-6;  // smallest scale; a matrix is a rotation times a scale
// How far the axes of a matrix may deviate from right angles and, relative to the scale, from equal
// lengths.
constexpr double kSkewTolerance = 1e-3;
constexpr double kExact = 1e-12;  // a scale that differs less from 1 counts as 1

}  // namespace

Result<RigidTransform> CamFromWorldOfOpenGl(const Mat34& world_from_opengl_camera) {
  for (const double number : world_from_opengl_camera.reshaped<Eigen::RowMajor>())
    if (!(std::abs(number) <= kLargest))
      return InputError(fmt::format("holds {:g}, expected numbers from {:g} to {:g}", number,
                                    -kLargest, kLargest));
  Mat3 axes = world_from_opengl_camera.leftCols<3>();
  const double determinant = axes.determinant();
  const double scale = std::cbrt(std::abs(determinant));
  if (!(scale >= kSmallestScale))
    return InputError(
        fmt::format("has the determinant {:g}: expected a rotation, times a scale of at least {:g}",
                    determinant, kSmallestScale));
  if (std::abs(scale - 1) > kExact) axes /= scale;
  LF_ASSIGN_OR_RETURN(axes, NearestRotation(axes, kSkewTolerance));
  RigidTransform cam_from_world;
  cam_from_world.rotation.row(0) = axes.col(0);
  cam_from_world.rotation.row(1) = -axes.col(1);
  cam_from_world.rotation.row(2) = -axes.col(2);
  // Subtraction from zero instead of negation gives no negative zeros.
  cam_from_world.translation =
      Vec3::Zero() - cam_from_world.rotation * world_from_opengl_camera.col(3);
  return cam_from_world;
}

Mat34 OpenGlOfCamFromWorld(const RigidTransform& cam_from_world) {
  Mat34 world_from_opengl_camera;
  world_from_opengl_camera.col(0) = cam_from_world.rotation.row(0);
  world_from_opengl_camera.col(1) = -cam_from_world.rotation.row(1);
  world_from_opengl_camera.col(2) = -cam_from_world.rotation.row(2);
  world_from_opengl_camera.col(3) = cam_from_world.Inverse().translation;
  return world_from_opengl_camera;
}

}  // namespace lf
