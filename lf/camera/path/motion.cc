// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/motion.h"

#include <algorithm>
#include <cmath>
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

bool LeavesFromRest(Interpolation interpolation) {
  return interpolation == Interpolation::kEase || interpolation == Interpolation::kEaseIn;
}

bool ComesToRest(Interpolation interpolation) {
  return interpolation == Interpolation::kEase || interpolation == Interpolation::kEaseOut;
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
  for (size_t begin = 0; begin + 1 < keys_.size();) {
    const size_t last = EndOfStretch(begin);
    Stretch stretch;
    stretch.begin = begin;
    stretch.rests_at_begin = LeavesFromRest(keys_[begin + 1].interpolation);
    stretch.rests_at_end = ComesToRest(keys_[last].interpolation);
    // Without eases, a slerp has a constant speed, and needs no curve of time.
    const bool has_curve = curve_ != SmoothCurve::kRotation || stretch.rests_at_begin ||
                           (last > begin && stretch.rests_at_end);
    if (last > begin && has_curve) {
      std::vector<double> times;
      for (size_t i = begin; i <= last; ++i) times.push_back(keys_[i].time_s);
      if (curve_ == SmoothCurve::kMonotone) FitMonotone(times, &stretch);
      if (curve_ == SmoothCurve::kCatmullRom) FitCatmullRom(times, &stretch);
      if (curve_ == SmoothCurve::kRotation) FitRotation(times, &stretch);
      stretches_.push_back(std::move(stretch));
    }
    begin = std::max(last, begin + 1);
  }
}

size_t KeyframeCurve::EndOfStretch(size_t begin) const {
  const Interpolation first = keys_[begin + 1].interpolation;
  if (first == Interpolation::kLinear || first == Interpolation::kStep) return begin;
  size_t last = begin + 1;
  if (ComesToRest(first)) return last;
  while (last + 1 < keys_.size() && keys_[last + 1].interpolation == Interpolation::kSmooth) ++last;
  if (last + 1 < keys_.size() && keys_[last + 1].interpolation == Interpolation::kEaseOut) ++last;
  return last;
}

std::vector<double> KeyframeCurve::Slopes(
    const Stretch& stretch, std::span<const double> times, std::span<const double> values,
    const std::function<double(const Key&, const Key&)>& change) const {
  std::vector<double> slopes = MonotoneSlopes(times, values);
  const bool is_one_segment = slopes.size() == 2;
  const double chord = slopes[0];  // if it is one segment
  // For a stretch of one segment that rests at one end: returns the slope at its other end, from
  // the segment beside it, whose keys have the indices `a` and `b`.
  const auto slope_beside = [&](size_t a, size_t b) {
    if (b >= keys_.size() || keys_[b].interpolation != Interpolation::kLinear) return 2 * chord;
    const double line = change(keys_[a], keys_[b]) / (keys_[b].time_s - keys_[a].time_s);
    if (line * chord <= 0) return 0.0;
    return std::copysign(std::min(std::abs(line), 3 * std::abs(chord)), chord);
  };
  const size_t begin = stretch.begin, last = begin + slopes.size() - 1;
  if (is_one_segment && stretch.rests_at_begin) slopes[1] = slope_beside(last, last + 1);
  if (is_one_segment && stretch.rests_at_end)
    slopes[0] = begin == 0 ? 2 * chord : slope_beside(begin - 1, begin);
  if (stretch.rests_at_begin) slopes.front() = 0;
  if (stretch.rests_at_end) slopes.back() = 0;
  return slopes;
}

void KeyframeCurve::FitMonotone(std::span<const double> times, Stretch* stretch) const {
  const Eigen::Index size = keys_[stretch->begin].value.size();
  stretch->knots.assign(times.begin(), times.end());
  stretch->knot_slopes.assign(times.size(), 1);
  stretch->slopes.assign(times.size(), MotionValue::Zero(size));
  std::vector<double> component(times.size());
  for (Eigen::Index c = 0; c < size; ++c) {
    for (size_t i = 0; i < times.size(); ++i) component[i] = keys_[stretch->begin + i].value[c];
    const std::vector<double> slopes =
        Slopes(*stretch, times, component,
               [c](const Key& a, const Key& b) { return b.value[c] - a.value[c]; });
    for (size_t i = 0; i < times.size(); ++i) stretch->slopes[i][c] = slopes[i];
  }
}

void KeyframeCurve::FitCatmullRom(std::span<const double> times, Stretch* stretch) const {
  std::vector<Vec3> points;
  for (size_t i = 0; i < times.size(); ++i) points.push_back(keys_[stretch->begin + i].value);
  stretch->knots = CentripetalKnots(points);
  // The points between two keys alone are on a straight line: a length is the knot times its root.
  const double root_length = stretch->knots[1];
  stretch->knot_slopes =
      Slopes(*stretch, times, stretch->knots, [root_length](const Key& a, const Key& b) {
        return root_length > 0 ? (b.value - a.value).norm() / root_length : 0;
      });
  for (const Vec3& slope : CatmullRomSlopes(stretch->knots, points))
    stretch->slopes.emplace_back(slope);
}

void KeyframeCurve::FitRotation(std::span<const double> times, Stretch* stretch) const {
  const auto angle = [](const Key& a, const Key& b) {
    return Quaternion(a.value).angularDistance(Quaternion(b.value));
  };
  stretch->knots.push_back(0);
  for (size_t i = 1; i < times.size(); ++i)
    stretch->knots.push_back(stretch->knots.back() +
                             angle(keys_[stretch->begin + i - 1], keys_[stretch->begin + i]));
  stretch->knot_slopes = Slopes(*stretch, times, stretch->knots, angle);
}

const KeyframeCurve::Stretch* KeyframeCurve::StretchOf(size_t index) const {
  const auto after =
      std::upper_bound(stretches_.begin(), stretches_.end(), index,
                       [](size_t i, const Stretch& stretch) { return i < stretch.begin; });
  if (after == stretches_.begin()) return nullptr;
  const Stretch& stretch = *(after - 1);
  return index + 1 < stretch.begin + stretch.knots.size() ? &stretch : nullptr;
}

MotionValue KeyframeCurve::At(double time_s) const {
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                     [](double t, const Key& key) { return t < key.time_s; });
  if (next == keys_.begin()) return keys_.front().value;
  if (next == keys_.end()) return keys_.back().value;
  const Key& a = *(next - 1);
  const Key& b = *next;
  if (b.interpolation == Interpolation::kStep) return a.value;
  const auto index = static_cast<size_t>(next - keys_.begin()) - 1;
  if (const Stretch* stretch = StretchOf(index)) return AtStretch(*stretch, index, time_s);
  return Interpolate(a, b, (time_s - a.time_s) / (b.time_s - a.time_s), curve_);
}

MotionValue KeyframeCurve::AtStretch(const Stretch& stretch, size_t index, double time_s) const {
  const Key& a = keys_[index];
  const Key& b = keys_[index + 1];
  const size_t i = index - stretch.begin;
  const double knot_a = stretch.knots[i];
  const double knot_b = stretch.knots[i + 1];
  if (!(knot_b > knot_a)) return a.value;  // keys a and b are the same point: the camera rests
  // kMonotone eases the values themselves; the other curves ease their knots.
  const Rests rests{i == 0 && stretch.rests_at_begin,
                    i + 2 == stretch.knots.size() && stretch.rests_at_end};
  const bool eases_values = curve_ == SmoothCurve::kMonotone;
  const double knot =
      EasedHermite(time_s, a.time_s, b.time_s, knot_a, knot_b, stretch.knot_slopes[i],
                   stretch.knot_slopes[i + 1], eases_values ? Rests() : rests);
  if (curve_ == SmoothCurve::kRotation)
    return Interpolate(a, b, (knot - knot_a) / (knot_b - knot_a), curve_);
  return EasedHermite(knot, knot_a, knot_b, a.value, b.value, stretch.slopes[i],
                      stretch.slopes[i + 1], eases_values ? rests : Rests());
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
