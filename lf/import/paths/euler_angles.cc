// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/euler_angles.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>

namespace lf {
namespace {

constexpr double kLocked = 1e-9;  // cosine of the middle angle at which the outer axes coincide

Mat3 RotationAbout(int axis, double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Vec3::Unit(axis)).toRotationMatrix();
}

// Returns the angle plus a number of whole turns, within half a turn of `before_rad`.
double Near(double angle_rad, double before_rad) {
  return angle_rad + 2 * kPi * std::round((before_rad - angle_rad) / (2 * kPi));
}

}  // namespace

std::optional<RotationOrder> RotationOrderOf(std::string_view name) {
  for (const RotationOrder order :
       {RotationOrder::kXyz, RotationOrder::kXzy, RotationOrder::kYxz, RotationOrder::kYzx,
        RotationOrder::kZxy, RotationOrder::kZyx}) {
    const auto [first, second, third] = AxesOf(order);
    constexpr std::string_view kNames = "xyz";
    if (name == std::string{kNames[first], kNames[second], kNames[third]}) return order;
  }
  return std::nullopt;
}

std::array<int, 3> AxesOf(RotationOrder order) {
  switch (order) {
    case RotationOrder::kXyz:
      return {0, 1, 2};
    case RotationOrder::kXzy:
      return {0, 2, 1};
    case RotationOrder::kYxz:
      return {1, 0, 2};
    case RotationOrder::kYzx:
      return {1, 2, 0};
    case RotationOrder::kZyx:
      return {2, 1, 0};
    case RotationOrder::kZxy:
      break;
  }
  return {2, 0, 1};
}

Mat3 RotationOfAngles(const Vec3& angles_rad, RotationOrder order) {
  Mat3 rotation = Mat3::Identity();
  for (const int axis : AxesOf(order)) rotation = RotationAbout(axis, angles_rad[axis]) * rotation;
  return rotation;
}

Vec3 AnglesOfRotation(const Mat3& rotation, RotationOrder order, const Vec3& before_rad) {
  // R = R_i(a) R_j(b) R_k(c). If i, j, k is a cyclic order of the axes, then
  //   R_ik = sin b    R_ii = cos b cos c    R_ij = -cos b sin c
  //   R_jk = -sin a cos b    R_kk = cos a cos b
  // Otherwise all angles have the other sign.
  const auto [k, j, i] = AxesOf(order);
  const double sign = (i + 1) % 3 == j ? 1 : -1;
  const double cosine = std::hypot(rotation(i, i), rotation(i, j));
  Vec3 angles;
  angles[j] = std::atan2(sign * rotation(i, k), cosine);
  if (cosine > kLocked) {
    angles[k] = std::atan2(-sign * rotation(i, j), rotation(i, i));
    angles[i] = std::atan2(-sign * rotation(j, k), rotation(k, k));
  } else {
    // Gimbal lock: only the sum or difference of a and c is known, so c is kept.
    angles[k] = before_rad[k];
    const Mat3 rest =
        rotation * (RotationAbout(j, angles[j]) * RotationAbout(k, angles[k])).transpose();
    angles[i] = std::atan2(sign * rest(k, j), rest(j, j));
  }
  Vec3 other;  // the second triple of angles that gives the rotation
  other[i] = angles[i] + kPi;
  other[j] = kPi - angles[j];
  other[k] = angles[k] + kPi;
  for (int axis = 0; axis < 3; ++axis) {
    angles[axis] = Near(angles[axis], before_rad[axis]);
    other[axis] = Near(other[axis], before_rad[axis]);
  }
  return (other - before_rad).norm() < (angles - before_rad).norm() ? other : angles;
}

}  // namespace lf
