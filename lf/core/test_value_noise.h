// SPDX-License-Identifier: Apache-2.0
// Texture of the synthetic scenes that tests of focus, densify and import/exposure render.
#pragma once

#include <cmath>
#include <cstdint>

#include "lf/core/random.h"

namespace lf {

// Returns value noise in [0, 1): random numbers on a lattice of width 1, interpolated smoothly.
inline double ValueNoise(double x, double y, uint64_t seed) {
  const double column = std::floor(x), row = std::floor(y), u = x - column, v = y - row;
  const auto at = [&](double i, double j) {
    return RandomUnit(seed, static_cast<uint64_t>(column + i + 100000),
                      static_cast<uint64_t>(row + j + 100000));
  };
  const double s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
  return std::lerp(std::lerp(at(0, 0), at(1, 0), s), std::lerp(at(0, 1), at(1, 1), s), t);
}

}  // namespace lf
