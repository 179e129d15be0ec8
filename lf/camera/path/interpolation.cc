// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/interpolation.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"

namespace lf {
namespace {

// Returns the slope, at the first of three values, of the parabola through them, limited so that
// the cubic stays monotone. h0 and h1 are the distances between the knots, d0 and d1 the slopes of
// the two chords.
double EndSlope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return 0;
  if (d0 * d1 <= 0 && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return slope;
}

// Returns the weighted harmonic mean of the slopes d0 and d1 of two chords, whose knots are h0 and
// h1 apart; 0 if the slopes do not have the same sign, as at a peak.
double InnerSlope(double h0, double h1, double d0, double d1) {
  if (d0 * d1 <= 0) return 0;
  const double w0 = 2 * h1 + h0;
  const double w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// Returns the indices of the first point and of all points whose knot differs from the knot of the
// point before.
std::vector<size_t> DistinctKnots(std::span<const double> knots) {
  std::vector<size_t> distinct;
  for (size_t i = 0; i < knots.size(); ++i)
    if (i == 0 || knots[i] > knots[i - 1]) distinct.push_back(i);
  return distinct;
}

}  // namespace

std::vector<double> MonotoneSlopes(std::span<const double> knots, std::span<const double> values) {
  const size_t n = knots.size();
  LF_CHECK(values.size() == n);
  std::vector<double> slopes(n, 0);
  if (n < 2) return slopes;
  std::vector<double> h(n - 1), d(n - 1);
  for (size_t i = 0; i + 1 < n; ++i) {
    h[i] = knots[i + 1] - knots[i];
    d[i] = (values[i + 1] - values[i]) / h[i];
  }
  if (n == 2) return {d[0], d[0]};
  for (size_t i = 1; i + 1 < n; ++i) slopes[i] = InnerSlope(h[i - 1], h[i], d[i - 1], d[i]);
  slopes[0] = EndSlope(h[0], h[1], d[0], d[1]);
  slopes[n - 1] = EndSlope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
  return slopes;
}

std::vector<double> CentripetalKnots(std::span<const Vec3> points) {
  std::vector<double> knots(points.size(), 0);
  for (size_t i = 1; i < points.size(); ++i)
    knots[i] = knots[i - 1] + std::sqrt((points[i] - points[i - 1]).norm());
  return knots;
}

std::vector<Vec3> CatmullRomSlopes(std::span<const double> knots, std::span<const Vec3> points) {
  LF_CHECK(knots.size() == points.size());
  std::vector<Vec3> slopes(points.size(), Vec3::Zero());
  const std::vector<size_t> distinct = DistinctKnots(knots);
  if (distinct.size() < 2) return slopes;
  const auto chord = [&](size_t a, size_t b) -> Vec3 {
    return (points[distinct[b]] - points[distinct[a]]) / (knots[distinct[b]] - knots[distinct[a]]);
  };
  const size_t last = distinct.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    // The slope at an inner point is the tangent of the Barry-Goldman pyramid.
    const Vec3 slope = i == 0      ? chord(0, 1)
                       : i == last ? chord(last - 1, last)
                                   : Vec3(chord(i - 1, i) - chord(i - 1, i + 1) + chord(i, i + 1));
    // A point and its repetitions share one knot, and therefore one slope.
    const size_t end = i == last ? points.size() : distinct[i + 1];
    std::fill(slopes.begin() + static_cast<std::ptrdiff_t>(distinct[i]),
              slopes.begin() + static_cast<std::ptrdiff_t>(end), slope);
  }
  return slopes;
}

Eigen::Quaterniond Slerp(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double x) {
  return a.slerp(x, b).normalized();
}

}  // namespace lf
