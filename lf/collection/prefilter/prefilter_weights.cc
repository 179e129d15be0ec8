// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>

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

Prefilter Found(double width_px, PixelFootprint footprint, bool of_mosaic) {
  const int beyond = static_cast<int>(std::ceil(width_px / 2));
  const Design odd = Designed(width_px, footprint, false, beyond + 2);
  const Design even = Designed(width_px, footprint, true, beyond + 2);
  Prefilter filter;
  filter.by_shares = of_mosaic;
  filter.is_even = of_mosaic || even.error < odd.error;
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

// Returns the width, rounded to steps.
int StepsOf(double width_px) {
  return static_cast<int>(std::lround(std::min(width_px, kWidestElement_px) * kSteps));
}

// Returns Found() for the rounded width.
Prefilter FoundOnce(double width_px, PixelFootprint footprint, bool of_mosaic) {
  const int steps = width_px > kFinerAtMost ? StepsOf(width_px) : static_cast<int>(kSteps);
  static std::mutex mutex;
  static std::map<std::tuple<int, PixelFootprint, bool>, Prefilter> known;
  const std::lock_guard lock(mutex);
  const auto [at, is_new] = known.try_emplace({steps, footprint, of_mosaic});
  if (is_new) at->second = Found(steps / kSteps, footprint, of_mosaic);
  return at->second;
}

}  // namespace

Prefilter PrefilterFor(double width_px, PixelFootprint footprint) {
  return FoundOnce(width_px, footprint, false);
}

Prefilter PrefilterOfMosaic(double width_px, PixelFootprint footprint) {
  return FoundOnce(width_px, footprint, true);
}

Prefilter MeanOfMosaic(double width_px, PixelFootprint footprint) {
  const double width = StepsOf(width_px) / kSteps;
  const double variance =
      footprint == PixelFootprint::kArea ? (width * width - 1) / 12 : width * width / 16;
  // Weights a, b at the distances 1/2 and 3/2 have the sum 2 (a + b) = 1 and the variance
  // 2 (a / 4 + 9 b / 4) = 1 / 4 + 4 b.
  const auto outer = static_cast<int16_t>(std::lround((variance - 0.25) / 4 * Prefilter::kOne));
  Prefilter filter;
  filter.by_shares = filter.is_even = true;
  filter.count = 2;
  filter.weights = {static_cast<int16_t>(Prefilter::kOne / 2 - outer), outer};
  return filter;
}

}  // namespace lf
