// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/ngp_curve.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"

namespace lf {
namespace {

// A place on the curve: between the keys `key` and key + 1.
struct NgpPlace {
  int key = 0;
  double share = 0;
};

NgpPlace PlaceAt(const NgpCurve& curve, double t) {
  const int count = static_cast<int>(curve.keys.size());
  if (count == 1) return {0, t};
  const int last = count - (curve.loop ? 1 : 2);  // the last key at which a segment begins
  const std::vector<double>& ends = curve.timestamps;
  const double time = t * ends[static_cast<size_t>(last)];
  const auto segment = std::upper_bound(ends.begin(), ends.end(), time) - ends.begin();
  const int key = std::clamp(static_cast<int>(segment), 0, last);
  const double begin = key == 0 ? 0 : ends[static_cast<size_t>(key) - 1];
  return {key, (time - begin) / (ends[static_cast<size_t>(key)] - begin)};
}

const NgpNumbers& KeyAt(const NgpCurve& curve, int index) {
  const int count = static_cast<int>(curve.keys.size());
  const int key = curve.loop ? (index + count) % count : std::clamp(index, 0, count - 1);
  return curve.keys[static_cast<size_t>(key)];
}

// Weights of the uniform B-spline for the keys around a place, the first of which is `first` keys
// after the place's key.
struct NgpWeights {
  int first = 0;
  std::vector<double> weights;
};

NgpWeights WeightsFor(int order, double x) {
  const double y = 1 - x;
  switch (order) {
    case 0:
      return {static_cast<int>(std::round(x)), {1}};
    case 1:
      return {0, {y, x}};
    case 2:
      return {-1, {y * y / 2, (1 + 2 * x * y) / 2, x * x / 2}};
    default:
      return {-1,
              {y * y * y / 6, (4 - 6 * x * x + 3 * x * x * x) / 6,
               (1 + 3 * x + 3 * x * x - 3 * x * x * x) / 6, x * x * x / 6}};
  }
}

// Returns true if the timestamps increase from above 0.
bool AreTimestamps(const std::vector<double>& timestamps) {
  double before = 0;
  for (const double timestamp : timestamps) {
    if (!(timestamp > before)) return false;
    before = timestamp;
  }
  return true;
}

}  // namespace

void RepairTimestamps(NgpCurve* curve) {
  if (AreTimestamps(curve->timestamps)) return;
  for (size_t i = 0; i < curve->timestamps.size(); ++i)
    curve->timestamps[i] = static_cast<double>(i + 1);
}

NgpNumbers At(const NgpCurve& curve, double t) {
  LF_CHECK(!curve.keys.empty() && curve.keys.size() == curve.timestamps.size());
  const NgpPlace place = PlaceAt(curve, t);
  const NgpWeights weights = WeightsFor(curve.spline_order, place.share);
  NgpNumbers sum = NgpNumbers::Zero();
  for (size_t i = 0; i < weights.weights.size(); ++i) {
    NgpNumbers key = KeyAt(curve, place.key + weights.first + static_cast<int>(i));
    // A quaternion and its negative are the same rotation; the nearer one is taken.
    if (key.head<4>().dot(sum.head<4>()) < 0) key.head<4>() *= -1;
    sum += weights.weights[i] * key;
  }
  const double length = sum.head<4>().norm();
  if (length > 0) sum.head<4>() /= length;
  return sum;
}

}  // namespace lf
