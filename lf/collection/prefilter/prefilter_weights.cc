// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

#include "lf/collection/prefilter/prefilter.h"

namespace lf {
namespace {

constexpr double kSteps = 16;  // steps of an element's width per LF pixel

// The power spectrum of scenes is assumed to fall as 1 / (f^2 + kLowFrequency^2), like that of
// edges; f is in cycles per LF pixel.
constexpr double kLowFrequency = 0.02;

// Returns N of prefilter.h, the number of rays that average aliasing. It was chosen with pictures
// of true lenses (doc/quality.md): a larger N makes the focus plane sharper, but blur that is made
// of few LF images aliases more.
double RaysFor(PixelFootprint footprint) { return footprint == PixelFootprint::kArea ? 3 : 6; }

double Sinc(double x) {
  const double angle = std::numbers::pi * x;
  return angle == 0 ? 1 : std::sin(angle) / angle;
}

struct Design {
  Eigen::VectorXd weights;
  double error = 0;
};

// Returns the filter of `count` different weights with the least error (prefilter.h).
Design Designed(double width_px, PixelFootprint footprint, bool is_even, int count) {
  constexpr double kMostFrequency = 4, kStep = 1. / 512;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(count + 1, count + 1);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(count + 1);
  double constant = 0;
  Eigen::VectorXd waves(count);
  for (double f = kStep / 2; f < kMostFrequency; f += kStep) {
    const double scene = 1 / (kLowFrequency * kLowFrequency + f * f);
    const double pixel = footprint == PixelFootprint::kArea ? Sinc(f) : 1;
    const double tent = Sinc(f) * Sinc(f), wanted = Sinc(width_px * f);
    // The sum of sinc(f + j)^4 over all integers j is (2 + cos(2 pi f)) / 3.
    const double aliased = (2 + std::cos(2 * std::numbers::pi * f)) / 3 - tent * tent;
    for (int k = 0; k < count; ++k)
      waves[k] = is_even  ? 2 * std::cos(2 * std::numbers::pi * (k + 0.5) * f)
                 : k == 0 ? 1
                          : 2 * std::cos(2 * std::numbers::pi * k * f);
    const double energy = scene * pixel * pixel * (tent * tent + aliased / RaysFor(footprint));
    a.topLeftCorner(count, count) += energy * waves * waves.transpose();
    b.head(count) += scene * pixel * tent * wanted * waves;
    constant += scene * wanted * wanted;
  }
  // The last equation demands that the weights add up to 1.
  for (int k = 0; k < count; ++k) a(k, count) = a(count, k) = !is_even && k == 0 ? 1 : 2;
  b[count] = 1;
  const Eigen::VectorXd solution = a.fullPivLu().solve(b);
  Design design;
  design.weights = solution.head(count);
  design.error = design.weights.dot(a.topLeftCorner(count, count) * design.weights) -
                 2 * b.head(count).dot(design.weights) + constant;
  return design;
}

Prefilter Found(double width_px, PixelFootprint footprint) {
  const int beyond = static_cast<int>(std::ceil(width_px / 2));
  const Design odd = Designed(width_px, footprint, false, beyond + 2);
  const Design even = Designed(width_px, footprint, true, beyond + 2);
  Prefilter filter;
  filter.is_even = even.error < odd.error;
  const Eigen::VectorXd& weights = filter.is_even ? even.weights : odd.weights;
  filter.count = static_cast<int>(weights.size());
  int sum = 0;
  for (int k = 0; k < filter.count; ++k) {
    const auto weight = static_cast<int16_t>(std::lround(weights[k] * Prefilter::kOne));
    filter.weights[static_cast<size_t>(k)] = weight;
    sum += (!filter.is_even && k == 0 ? 1 : 2) * weight;
  }
  // The weights nearest to the knot make up for rounding.
  const int error = sum - Prefilter::kOne;
  filter.weights[0] =
      static_cast<int16_t>(filter.weights[0] - (filter.is_even ? error / 2 : error));
  return filter;
}

}  // namespace

Prefilter PrefilterFor(double width_px, PixelFootprint footprint) {
  const double limited_px = width_px > kFinerAtMost ? std::min(width_px, kWidestElement_px) : 1;
  const int steps = static_cast<int>(std::lround(limited_px * kSteps));
  static std::mutex mutex;
  static std::map<std::pair<int, PixelFootprint>, Prefilter> known;
  const std::lock_guard lock(mutex);
  const auto [at, is_new] = known.try_emplace({steps, footprint});
  if (is_new) at->second = Found(steps / kSteps, footprint);
  return at->second;
}

}  // namespace lf
