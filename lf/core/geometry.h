// SPDX-License-Identifier: Apache-2.0
// Points, transforms and regions shared by all folders.
//
// World: right-handed. Camera axes: x right, y down, z forward. Continuous pixel coordinates: the
// centre of the upper left pixel is (0.5, 0.5). Lengths are world units, angles radians
// (doc/conventions.md).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace lf {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double RadiansFromDegrees(double degrees) { return degrees * (kPi / 180.0); }
inline constexpr double DegreesFromRadians(double radians) { return radians * (180.0 / kPi); }

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

// Returns twice the area of the triangle (0, a, b), positive if a turns to b in the same sense as
// the x axis turns to the y axis.
inline double Cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// A linear form on homogeneous pixel positions: form * (x, y, 1)^T.
using PixelForm = Eigen::RowVector3d;
inline double Value(const PixelForm& form, double x_px, double y_px) {
  return form[0] * x_px + form[1] * y_px + form[2];
}
inline double Value(const PixelForm& form, const Vec3& position) {
  return form[0] * position[0] + form[1] * position[1] + form[2] * position[2];
}

// Converts coordinates in frame of reference a to b: x_b = rotation * x_a + translation. A variable
// of this type is named b_from_a.
struct RigidTransform {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 operator*(const Vec3& point_a) const { return rotation * point_a + translation; }
  // Composes two transforms: c_from_a = c_from_b * b_from_a, where this one is c_from_b.
  RigidTransform operator*(const RigidTransform& b_from_a) const {
    return {rotation * b_from_a.rotation, rotation * b_from_a.translation + translation};
  }
  RigidTransform Inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }
};

// The points X with normal . X = offset_w; |normal| = 1.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
  double offset_w = 0;
};

// Depths along an optical axis, in world units.
struct DepthRange {
  double near_w = 0;
  double far_w = 0;
  friend bool operator==(const DepthRange&, const DepthRange&) = default;
};

// Pixels [x_begin, x_end) x [y_begin, y_end).
struct PixelRect {
  int x_begin = 0;
  int y_begin = 0;
  int x_end = 0;
  int y_end = 0;

  int width() const { return std::max(0, x_end - x_begin); }
  int height() const { return std::max(0, y_end - y_begin); }
  bool empty() const { return x_end <= x_begin || y_end <= y_begin; }
  long long pixel_count() const { return static_cast<long long>(width()) * height(); }
  bool Contains(int x, int y) const {
    return x >= x_begin && x < x_end && y >= y_begin && y < y_end;
  }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

inline PixelRect Intersection(const PixelRect& a, const PixelRect& b) {
  const PixelRect r{std::max(a.x_begin, b.x_begin), std::max(a.y_begin, b.y_begin),
                    std::min(a.x_end, b.x_end), std::min(a.y_end, b.y_end)};
  return r.empty() ? PixelRect{} : r;
}

// Returns the smallest rectangle that contains a and b. An empty rectangle is ignored.
inline PixelRect Bounds(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x_begin, b.x_begin), std::min(a.y_begin, b.y_begin),
          std::max(a.x_end, b.x_end), std::max(a.y_end, b.y_end)};
}

}  // namespace lf
