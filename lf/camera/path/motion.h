// SPDX-License-Identifier: Apache-2.0
// One quantity of a camera path as a function of time, given by accelerations (thesis 4.5.1) or by
// keyframes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <variant>
#include <vector>

namespace lf {

// Value of a quantity with one to four components: a number, two tilts, a point, three angles or a
// quaternion (w, x, y, z).
using MotionValue = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;

// A constant acceleration during the time [from_s, to_s).
struct AccelerationPeriod {
  double from_s = 0;
  double to_s = 0;
  MotionValue acceleration;  // change of the speed per second
};

struct AcceleratedMotion {
  MotionValue initial;  // value at time 0
  MotionValue speed;    // change of the value per second, at time 0
  std::vector<AccelerationPeriod> periods;
};

// Returns the value x(t) at time t, for the initial value x0, the initial speed v0 and periods of
// constant acceleration a. The speed reached at the end of a period is kept, and the accelerations
// of overlapping periods add up:
//
//   x(t) = x0 + v0 t + sum over periods of  a (s^2 / 2 + s (t - from - s)),
//   s    = min(t, to) - from, the time spent in the period; 0 if t < from
MotionValue ValueAt(const AcceleratedMotion& motion, double time_s);

// Shape of the curve between the previous key and the key that has this interpolation.
enum class Interpolation { kSmooth, kLinear, kStep };

struct Key {
  double time_s = 0;
  MotionValue value;
  Interpolation interpolation = Interpolation::kSmooth;
};

// Kind of the curve that leads to a key with kSmooth. A straight line leads to a key with kLinear;
// for unit quaternions (kRotation), a slerp does.
enum class SmoothCurve {
  kMonotone,    // every component is a monotone cubic, without overshoot
  kCatmullRom,  // for points: centripetal Catmull-Rom; its parameter is a monotone cubic of time
  kRotation,    // for unit quaternions: slerp
};

// The curve through keys. Smooth keys form one curve up to the last key before a linear or step
// key; the next smooth curve begins at this linear or step key. Before the first key, the value of
// the first key holds; after the last key, the value of the last.
class KeyframeCurve {
 public:
  // keys   at least one; their times are strictly increasing, their values have the same number of
  //        components
  KeyframeCurve(std::vector<Key> keys, SmoothCurve curve);

  MotionValue At(double time_s) const;
  size_t key_count() const { return keys_.size(); }

 private:
  MotionValue AtSmooth(const Key& a, const Key& b, size_t index, double time_s) const;
  void FitMonotone(size_t begin, size_t end);
  void FitCatmullRom(size_t begin, size_t end);

  SmoothCurve curve_;
  std::vector<Key> keys_;
  // Parameters of the smooth curve for each key: its knot (interpolation.h), the slope of the knot
  // over time, and the slope of the value over the knot. Empty for kRotation.
  std::vector<double> knots_;
  std::vector<double> knot_slopes_;
  std::vector<MotionValue> slopes_;
};

using Motion = std::variant<AcceleratedMotion, KeyframeCurve>;
MotionValue ValueAt(const Motion& motion, double time_s);
bool Moves(const Motion& motion);

}  // namespace lf
