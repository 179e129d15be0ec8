// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/motion.h"

#include <algorithm>
#include <utility>

#include "lf/camera/path/interpolation.h"
#include "lf/core/check.h"

namespace lf {
namespace {

Eigen::Quaterniond Quaternion(const MotionValue& wxyz) {
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

MotionValue Interpolate(const Key& a, const Key& b, double share, SmoothCurve curve) {
  if (curve != SmoothCurve::kRotation) return a.value + share * (b.value - a.value);
  const Eigen::Quaterniond q = Slerp(Quaternion(a.value), Quaternion(b.value), share);
  return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
}

}  // namespace

MotionValue ValueAt(const AcceleratedMotion& motion, double time_s) {
  MotionValue value = motion.initial + time_s * motion.speed;
  for (const AccelerationPeriod& period : motion.periods) {
    if (time_s <= period.from_s) continue;
    const double inside_s = std::min(time_s, period.to_s) - period.from_s;
    const double after_s = time_s - period.from_s - inside_s;
    value += (inside_s * (inside_s / 2 + after_s)) * period.acceleration;
  }
  return value;
}

KeyframeCurve::KeyframeCurve(std::vector<Key> keys, SmoothCurve curve)
    : curve_(curve), keys_(std::move(keys)) {
  LF_CHECK(!keys_.empty());
  if (curve_ == SmoothCurve::kRotation) return;
  knots_.resize(keys_.size());
  knot_slopes_.resize(keys_.size(), 1);
  slopes_.resize(keys_.size());
  for (size_t begin = 0; begin < keys_.size();) {
    size_t end = begin + 1;
    while (end < keys_.size() && keys_[end].interpolation == Interpolation::kSmooth) ++end;
    if (curve_ == SmoothCurve::kMonotone) FitMonotone(begin, end);
    if (curve_ == SmoothCurve::kCatmullRom) FitCatmullRom(begin, end);
    begin = end;
  }
}

void KeyframeCurve::FitMonotone(size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    knots_[i] = keys_[i].time_s;
    slopes_[i] = MotionValue::Zero(keys_[i].value.size());
  }
  const std::span<const double> times(knots_.data() + begin, end - begin);
  std::vector<double> component(end - begin);
  for (Eigen::Index c = 0; c < keys_[begin].value.size(); ++c) {
    for (size_t i = begin; i < end; ++i) component[i - begin] = keys_[i].value[c];
    const std::vector<double> slopes = MonotoneSlopes(times, component);
    for (size_t i = begin; i < end; ++i) slopes_[i][c] = slopes[i - begin];
  }
}

void KeyframeCurve::FitCatmullRom(size_t begin, size_t end) {
  std::vector<double> times;
  std::vector<Vec3> points;
  for (size_t i = begin; i < end; ++i) {
    times.push_back(keys_[i].time_s);
    points.push_back(keys_[i].value);
  }
  const std::vector<double> knots = CentripetalKnots(points);
  const std::vector<double> knot_slopes = MonotoneSlopes(times, knots);
  const std::vector<Vec3> slopes = CatmullRomSlopes(knots, points);
  for (size_t i = begin; i < end; ++i) {
    knots_[i] = knots[i - begin];
    knot_slopes_[i] = knot_slopes[i - begin];
    slopes_[i] = slopes[i - begin];
  }
}

MotionValue KeyframeCurve::At(double time_s) const {
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                     [](double t, const Key& key) { return t < key.time_s; });
  if (next == keys_.begin()) return keys_.front().value;
  if (next == keys_.end()) return keys_.back().value;
  const Key& a = *(next - 1);
  const Key& b = *next;
  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  if (b.interpolation == Interpolation::kStep) return a.value;
  if (b.interpolation == Interpolation::kLinear || curve_ == SmoothCurve::kRotation)
    return Interpolate(a, b, share, curve_);
  return AtSmooth(a, b, static_cast<size_t>(next - keys_.begin()) - 1, time_s);
}

MotionValue KeyframeCurve::AtSmooth(const Key& a, const Key& b, size_t index, double time_s) const {
  const double knot_a = knots_[index];
  const double knot_b = knots_[index + 1];
  if (!(knot_b > knot_a)) return a.value;  // keys a and b are the same point: the camera rests
  const double knot = CubicHermite(time_s, a.time_s, b.time_s, knot_a, knot_b, knot_slopes_[index],
                                   knot_slopes_[index + 1]);
  return CubicHermite(knot, knot_a, knot_b, a.value, b.value, slopes_[index], slopes_[index + 1]);
}

MotionValue ValueAt(const Motion& motion, double time_s) {
  if (const auto* accelerated = std::get_if<AcceleratedMotion>(&motion))
    return ValueAt(*accelerated, time_s);
  return std::get<KeyframeCurve>(motion).At(time_s);
}

bool Moves(const Motion& motion) {
  if (const auto* accelerated = std::get_if<AcceleratedMotion>(&motion))
    return !accelerated->periods.empty() || !accelerated->speed.isZero(0);
  return std::get<KeyframeCurve>(motion).key_count() > 1;
}

}  // namespace lf
