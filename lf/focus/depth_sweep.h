// SPDX-License-Identifier: Apache-2.0
// The depths that a plane sweep tests, and functions that find the best of them. Internal to focus.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace lf {

// Depths that are evenly spaced in 1 / depth, the nearest first. Names with per_w and PerW() mean
// 1 / depth, per world unit.
struct DepthSweep {
  double from_per_w = 0, step_per_w = 0;
  size_t count = 0;

  double PerW(double index) const { return from_per_w - step_per_w * index; }
  double Depth(double index) const { return 1 / std::max(1e-12, PerW(index)); }
};

// Returns the mean of the `count` largest values. Sorts the values.
inline double MeanOfLargest(std::vector<double>* values, size_t count) {
  std::sort(values->begin(), values->end(), std::greater<>());
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += (*values)[i];
  return sum / static_cast<double>(count);
}

// Returns the largest local maximum of `scores` that lies more than `width` indices before `first`
// or after `last`. Returns `none` if no such maximum is larger than `none`. The first and the last
// score do not count as maxima.
inline double PeakElsewhere(std::span<const double> scores, size_t first, size_t last, size_t width,
                            double none) {
  double rival = none;
  for (size_t i = 1; i + 1 < scores.size(); ++i)
    if ((i + width < first || i > last + width) && scores[i] >= scores[i - 1] &&
        scores[i] >= scores[i + 1])
      rival = std::max(rival, scores[i]);
  return rival;
}

// Returns the index, in fractions, where the parabola through the best score and the two scores
// beside it is largest. Returns `best` if one of the two is missing or may not be used, or if the
// parabola has no maximum.
//   counts  returns true if a score beside the best one may be used
template <class Counts>
double VertexAround(std::span<const double> scores, size_t best, const Counts& counts) {
  const auto index = static_cast<double>(best);
  if (best == 0 || best + 1 >= scores.size()) return index;
  const double before = scores[best - 1], after = scores[best + 1];
  const double bend = before - 2 * scores[best] + after;
  if (!counts(before) || !counts(after) || !(bend < 0)) return index;
  return index + 0.5 * (before - after) / bend;
}

}  // namespace lf
