// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace lf {

// Returns 0 up to `from`, 1 from `to` on, and between them s^2 (3 - 2 s), which has no kinks.
inline double SmoothStep(double value, double from, double to) {
  const double s = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

}  // namespace lf
