// SPDX-License-Identifier: Apache-2.0
// Sums, products and principal axes of points that are the same numbers on every machine. Internal
// to this folder.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "lf/core/geometry.h"

namespace lf {

// Sums are plain loops: a library may add in another order on another machine.
inline double Dot(const Vec3& a, const Vec3& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}
inline double Length(const Vec3& a) { return std::sqrt(Dot(a, a)); }
inline Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}
inline Vec3 Unit(const Vec3& a) {
  const double length = Length(a);
  return {a.x() / length, a.y() / length, a.z() / length};
}

// Returns the mean of the points, of which there must be at least one.
Vec3 MeanOf(std::span<const Vec3> points);

// Orthogonal axes, and the variance of points along each of them, the largest first.
struct PrincipalAxes {
  std::array<Vec3, 3> axes;
  std::array<double, 3> variances{};
};

// Returns the axes of points that are relative to their mean.
PrincipalAxes AxesOf(std::span<const Vec3> points);

}  // namespace lf
