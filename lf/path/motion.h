// One quantity of the path as a function of time: moved by accelerations (thesis 4.5.1) or through
// keyframes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <variant>
#include <vector>

namespace lf {

// A number, two tilts, a point, three angles or a quaternion (w, x, y, z): one to four components.
using MotionValue = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;

// Acceleration a during [from, to).
struct AccelerationPeriod {
  double from_s = 0;
  double to_s = 0;
  MotionValue acceleration;  // per second squared
};

struct AcceleratedMotion {
  MotionValue initial;  // at time 0
  MotionValue speed;    // at time 0, per second
  std::vector<AccelerationPeriod> periods;
};

// Value after constant accelerations; after a period the speed it reached is kept, periods that
// overlap add up:
//
//   x(t) = x0 + v0 t + sum over periods of  a (s^2 / 2 + s (t - from - s)),
//   s    = min(t, to) - from, the time spent in the period; 0 before it
MotionValue ValueAt(const AcceleratedMotion& motion, double time_s);

// How a key is reached from the key before it.
enum class Interpolation { kSmooth, kLinear, kStep };

struct Key {
  double time_s = 0;
  MotionValue value;
  Interpolation interpolation = Interpolation::kSmooth;
};

// What kSmooth means, and for kRotation kLinear too.
enum class SmoothCurve {
  kMonotone,    // every component a monotone cubic: no overshoot
  kCatmullRom,  // points: centripetal Catmull-Rom, its parameter a monotone cubic of time
  kRotation,    // unit quaternions: slerp
};

// The curve through keys. A smooth stretch ends where a linear or step one begins. Before the
// first key its value holds, after the last one that.
class KeyframeCurve {
 public:
  // keys   at least one, times strictly increasing, values of one size
  KeyframeCurve(std::vector<Key> keys, SmoothCurve curve);

  MotionValue At(double time_s) const;
  size_t key_count() const { return keys_.size(); }

 private:
  MotionValue AtSmooth(const Key& a, const Key& b, size_t index, double time_s) const;
  void FitMonotone(size_t begin, size_t end);
  void FitCatmullRom(size_t begin, size_t end);

  SmoothCurve curve_;
  std::vector<Key> keys_;
  // Of the smooth curve, per key: its parameter, the parameter's slope over time, and the value's
  // slope over the parameter.
  std::vector<double> knots_;
  std::vector<double> knot_slopes_;
  std::vector<MotionValue> slopes_;
};

using Motion = std::variant<AcceleratedMotion, KeyframeCurve>;
MotionValue ValueAt(const Motion& motion, double time_s);
bool Moves(const Motion& motion);

}  // namespace lf
