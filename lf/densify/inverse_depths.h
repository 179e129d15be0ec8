// SPDX-License-Identifier: Apache-2.0
// How depths are kept: as inverse depths along the optical axis of a camera, because disparities
// between LF images are proportional to these.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lf {

// The inverse depths, in 1 / world unit, that 16-bit numbers stand for: 1 is `least`, 65535 is
// `greatest`, others are spaced evenly. 0 stands for an unknown depth.
struct InverseDepths {
  double least = 0;
  double greatest = 1;  // must exceed `least`

  static constexpr uint16_t kUnknown = 0;
  static constexpr double kLast = 65534;

  double Step() const { return (greatest - least) / kLast; }
  double Of(uint16_t number) const { return least + (number - 1) * Step(); }
  // Returns the number nearest to an inverse depth. Depths outside the range become its ends.
  uint16_t NumberOf(double inverse_depth) const {
    const double place = std::floor((inverse_depth - least) / Step() + 0.5);
    return static_cast<uint16_t>(1 + std::clamp(place, 0.0, kLast));
  }
};

}  // namespace lf
