#include "lf/capture/opengl_pose.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

namespace lf {
namespace {

constexpr double kLargest = 1e12;
constexpr double kSmallestScale = 1e-6;
constexpr double kSkewTolerance = 1e-3;
constexpr double kExact = 1e-12;

// How far the columns are from right angles and unit length.
double Skew(const Mat3& axes) {
  return (axes.transpose() * axes - Mat3::Identity()).cwiseAbs().maxCoeff();
}

// The orthogonal factor of the polar decomposition, by Newton's iteration (Higham 1986); from
// within kSkewTolerance three steps reach machine precision.
Mat3 NearestRotation(Mat3 axes) {
  for (int i = 0; i < 4; ++i) axes = 0.5 * (axes + axes.inverse().transpose()).eval();
  return axes;
}

}  // namespace

Result<RigidTransform> CamFromWorldOfOpenGl(const Mat34& world_from_opengl_camera) {
  if (!world_from_opengl_camera.allFinite() ||
      world_from_opengl_camera.cwiseAbs().maxCoeff() > kLargest)
    return InputError(fmt::format("holds a number beyond {:g}", kLargest));
  Mat3 axes = world_from_opengl_camera.leftCols<3>();
  const double determinant = axes.determinant();
  const double scale = std::cbrt(std::abs(determinant));
  if (!(scale >= kSmallestScale))
    return InputError(
        fmt::format("has the determinant {:g}: expected a rotation, of any scale", determinant));
  if (determinant < 0)
    return InputError(
        "is mirrored (its determinant is negative): expected the right-handed axes right, up, "
        "backward as columns");
  if (!(std::abs(scale - 1) <= kExact && Skew(axes) <= kExact)) {
    axes /= scale;
    const double skew = Skew(axes);
    if (!(skew <= kSkewTolerance))
      return InputError(
          fmt::format("is sheared or scaled unevenly: its axes miss right angles and equal lengths "
                      "by {:.2g}, more than {:g}",
                      skew, kSkewTolerance));
    axes = NearestRotation(axes);
  }
  RigidTransform cam_from_world;
  cam_from_world.rotation.row(0) = axes.col(0);
  cam_from_world.rotation.row(1) = -axes.col(1);
  cam_from_world.rotation.row(2) = -axes.col(2);
  // Subtracted from zero, not negated: no zero of the result has a minus sign.
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
