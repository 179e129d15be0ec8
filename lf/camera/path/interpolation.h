// SPDX-License-Identifier: Apache-2.0
// Curves through given values, as pure functions. A "knot" is the parameter at which a value is
// reached: a time, or for Catmull-Rom curves a length-like parameter.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

// Returns the slopes at the knots of the monotone cubic (Fritsch and Butland 1984). The slopes at
// the two ends follow the three-point formula, limited so that the curve stays monotone. Between
// two knots the curve never leaves the range of their values.
//
// knots   strictly increasing, as many as values; a single value has slope 0
std::vector<double> MonotoneSlopes(std::span<const double> knots, std::span<const double> values);

// Returns the knots of the centripetal Catmull-Rom curve through the points P: knot[0] = 0,
//   knot[i + 1] = knot[i] + |P[i + 1] - P[i]|^(1/2)        (Yuksel, Schaefer and Keyser 2011)
// The curve has no cusp and no loop between two points. A repeated point repeats its knot.
std::vector<double> CentripetalKnots(std::span<const Vec3> points);

// Returns the slopes dP/dknot of the centripetal Catmull-Rom curve at its points. At the first and
// the last point, the slope is along the chord to the neighbouring point.
std::vector<Vec3> CatmullRomSlopes(std::span<const double> knots, std::span<const Vec3> points);

// Returns the value at `knot` of the cubic with the given values and slopes at both ends of
// [knot_a, knot_b], knot_a < knot_b. T is double or an Eigen vector.
template <class T>
T CubicHermite(double knot, double knot_a, double knot_b, const T& value_a, const T& value_b,
               const T& slope_a, const T& slope_b) {
  const double h = knot_b - knot_a;
  const double x = (knot - knot_a) / h;
  const double y = 1 - x;
  const T values = (y * y * (1 + 2 * x)) * value_a + (x * x * (1 + 2 * y)) * value_b;
  const T slopes = (h * x * y * y) * slope_a - (h * x * x * y) * slope_b;
  return values + slopes;
}

// Tells at which ends of an interval a value rests: its speed and its acceleration are 0 there.
struct Rests {
  bool at_a = false;
  bool at_b = false;
};

// Returns the value at `knot` of the polynomial of least degree with the given values at both ends
// of [knot_a, knot_b], knot_a < knot_b, which rests at the ends that `rests` names and has the
// given slope at the others. With x = (knot - knot_a) / (knot_b - knot_a), from 0 to 1, and slopes
// m per x:
//
//   no rest       CubicHermite()
//   rest at a     (4 - m) x^3 + (m - 3) x^4, which is 2 x^3 - x^4 for m = 2
//   rest at b     1 - f(1 - x), where f is the polynomial of a rest at a
//   rests at both 10 x^3 - 15 x^4 + 6 x^5
//
// The curve stays between both values if slopes are from 0 to 3 times the slope of the chord. The
// weights of value_a and value_b are not negative and add up to 1.
template <class T>
T EasedHermite(double knot, double knot_a, double knot_b, const T& value_a, const T& value_b,
               const T& slope_a, const T& slope_b, const Rests& rests) {
  const double h = knot_b - knot_a;
  const double x = (knot - knot_a) / h;
  const double y = 1 - x;
  if (rests.at_a && rests.at_b)
    return (y * y * y * (10 - 15 * y + 6 * y * y)) * value_a +
           (x * x * x * (10 - 15 * x + 6 * x * x)) * value_b;
  if (rests.at_a) {
    const T values =
        (y * y * (1 + 2 * x + 3 * x * x)) * value_a + (x * x * x * (4 - 3 * x)) * value_b;
    return values - (h * x * x * x * y) * slope_b;
  }
  if (rests.at_b) {
    const T values =
        (y * y * y * (4 - 3 * y)) * value_a + (x * x * (1 + 2 * y + 3 * y * y)) * value_b;
    return values + (h * x * y * y * y) * slope_a;
  }
  return CubicHermite(knot, knot_a, knot_b, value_a, value_b, slope_a, slope_b);
}

// Returns the rotation at a share x in [0, 1] of the way from a to b, at constant angular speed
// along the shorter arc.
Eigen::Quaterniond Slerp(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double x);

}  // namespace lf
