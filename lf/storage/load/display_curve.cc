// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/display_curve.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"
#include "lf/light_field/model/radiance.h"

namespace lf {
namespace {

constexpr int kLargest = 65535;
constexpr double kSlopeAtBlack = 12.92;

double Displayed(double radiance) {
  return radiance < 0 ? kSlopeAtBlack * radiance : SrgbFromLinear(radiance);
}
double Radiance(double displayed) {
  return displayed < 0 ? displayed / kSlopeAtBlack : LinearFromSrgb(displayed);
}

uint16_t Rounded(double value) {
  return static_cast<uint16_t>(std::clamp<long>(std::lround(value), 0, kLargest));
}

}  // namespace

DisplayCurve::DisplayCurve(double black_level, double white_level)
    : on_curve_(kLargest + 1), stored_(kLargest + 1) {
  LF_CHECK(black_level < white_level);
  const double range = white_level - black_level;
  const double lowest = Displayed(-black_level / range);
  const double highest = Displayed((kLargest - black_level) / range);
  const double scale = kLargest / (highest - lowest);
  for (int value = 0; value <= kLargest; ++value) {
    on_curve_[value] = Rounded((Displayed((value - black_level) / range) - lowest) * scale);
    stored_[value] = Rounded(black_level + range * Radiance(lowest + value / scale));
  }
  grey_step_ = scale / 255;
}

}  // namespace lf
