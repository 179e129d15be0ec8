// SPDX-License-Identifier: Apache-2.0
// One quantity of a camera path as a function of time, given by accelerations (thesis 4.5.1) or by
// keyframes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
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
//
//   kEase     leaves the previous key from rest and comes to rest at this key
//   kEaseIn   leaves the previous key from rest
//   kEaseOut  comes to rest at this key
//
// At rest, speed and acceleration are 0.
enum class Interpolation { kSmooth, kLinear, kStep, kEase, kEaseIn, kEaseOut };

struct Key {
  double time_s = 0;
  MotionValue value;
  Interpolation interpolation = Interpolation::kSmooth;
};

// Kind of the curve that leads to a key with kSmooth or an ease. A straight line leads to a key
// with kLinear; for unit quaternions (kRotation), a slerp does.
enum class SmoothCurve {
  kMonotone,    // every component is a monotone curve, without overshoot
  kCatmullRom,  // for points: centripetal Catmull-Rom; its parameter is a monotone curve of time
  kRotation,    // for unit quaternions: slerp; with eases, its angle is a monotone curve of time
};

// The curve through keys. Smooth keys form a *stretch*, one curve up to the last key before a key
// of another kind, at which the next stretch begins. Before the first key, the value of the first
// key holds; after the last key, the value of the last.
//
// A key with kEaseIn may be the first of a stretch, and one with kEaseOut the last: the curve then
// leaves from rest, or comes to rest, and its speed is continuous between. A stretch that is one
// segment of kEaseIn reaches its key with the speed of the segment after it if that one is linear,
// but at most 3 times its own mean speed, and 0 if the line leads back; otherwise with twice its
// mean speed. One segment of kEaseOut begins likewise. A segment of kEase is a stretch of its own.
// The polynomials are those of EasedHermite() (interpolation.h).
class KeyframeCurve {
 public:
  // keys   at least one; their times are strictly increasing, their values have the same number of
  //        components
  KeyframeCurve(std::vector<Key> keys, SmoothCurve curve);

  MotionValue At(double time_s) const;
  size_t key_count() const { return keys_.size(); }

 private:
  // The parameters of a stretch for each of its keys: its knot (interpolation.h), which is a time,
  // length-like or an angle, the slope of the knot over time, and the slope of the value over the
  // knot, which rotations do not have.
  struct Stretch {
    size_t begin = 0;  // index of its first key
    bool rests_at_begin = false;
    bool rests_at_end = false;
    std::vector<double> knots;
    std::vector<double> knot_slopes;
    std::vector<MotionValue> slopes;
  };

  // Returns the index of the last key of the stretch that begins at the key `begin`; `begin` if the
  // next key has kLinear or kStep.
  size_t EndOfStretch(size_t begin) const;
  void FitMonotone(std::span<const double> times, Stretch* stretch) const;
  void FitCatmullRom(std::span<const double> times, Stretch* stretch) const;
  void FitRotation(std::span<const double> times, Stretch* stretch) const;
  // Returns the slopes of values at the times of the keys of a stretch. `change` returns by how
  // much such a value changes between two keys of the same linear segment.
  std::vector<double> Slopes(const Stretch& stretch, std::span<const double> times,
                             std::span<const double> values,
                             const std::function<double(const Key&, const Key&)>& change) const;
  // Returns the stretch that the segment after the key `index` is part of; null if there is none.
  const Stretch* StretchOf(size_t index) const;
  MotionValue AtStretch(const Stretch& stretch, size_t index, double time_s) const;

  SmoothCurve curve_;
  std::vector<Key> keys_;
  std::vector<Stretch> stretches_;  // in the order of their keys
};

using Motion = std::variant<AcceleratedMotion, KeyframeCurve>;
MotionValue ValueAt(const Motion& motion, double time_s);
bool Moves(const Motion& motion);

}  // namespace lf
