// SPDX-License-Identifier: Apache-2.0
// Bounds of linear forms on an arc or a patch of ideal positions. Internal to collection.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "lf/camera/ideal_pixels.h"
#include "lf/core/geometry.h"

namespace lf {

// The control points of an arc or a patch, and their largest absolute value in each coordinate.
struct Hull {
  std::span<const Vec3> control;
  Vec3 reach;
  explicit Hull(std::span<const Vec3> points) : control(points), reach(points[0].cwiseAbs()) {
    for (const Vec3& point : points) reach = reach.cwiseMax(point.cwiseAbs());
  }
  explicit Hull(const IdealArc& arc) : Hull(std::span(arc.control)) {}
  explicit Hull(const IdealPatch& patch)
      : Hull(std::span(&patch.control[0][0],
                       size_t{IdealPatch::kControls} * IdealPatch::kControls)) {}
};

// The smallest and the largest value that a form can have on a hull. The computed sign of a value
// closer to 0 than `rounding` may be wrong.
struct Range {
  double low = 0;
  double high = 0;
  double rounding = 0;

  double LeastSquare() const {
    return low <= 0 && high >= 0 ? 0 : std::min(low * low, high * high);
  }
  double Most() const { return std::max(-low, high); }
  double LargestSquare() const { return Most() * Most(); }
};

// Bound of the rounding error of a form's value, relative to the sum of its absolute terms.
inline constexpr double kFormRounding = 1e-9;

inline Range RangeOn(const Hull& hull, const PixelForm& form) {
  Range range;
  range.low = range.high = Value(form, hull.control[0]);
  for (const Vec3& point : hull.control.subspan(1)) {
    const double value = Value(form, point);
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  range.rounding = kFormRounding * form.cwiseAbs().dot(hull.reach);
  return range;
}

// Returns a bound of the rounding error of right^2 + up^2 - radius^2 forward^2.
inline double DiskRounding(const Range& right, const Range& up, const Range& forward,
                           double radius) {
  return 10 * kFormRounding *
         (right.LargestSquare() + up.LargestSquare() + radius * radius * forward.LargestSquare());
}

}  // namespace lf
