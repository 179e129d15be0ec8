// SPDX-License-Identifier: Apache-2.0
// Fixed-point arithmetic that both implementations of demosaicing share. Internal to this folder.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "lf/core/check.h"
#include "lf/core/geometry.h"

namespace lf {

// A colour is computed as a sum in units of 1/4096: weights of pixels are multiples of 1/16, ratios
// of white balance factors are multiples of 1/256.
inline constexpr int kWeightBits = 4;
inline constexpr int kRatioBits = 8;
// Largest ratio of white balance factors: 8, in units of 1/256. With it no sum reaches 2^31,
// because the weights of a sum are at most 4096 (mean) and 12 * 2048 (Laplacian): (4096 + 12 *
// 2048) * 65535 < 2^31.
inline constexpr int32_t kMaxRatio = 8 << kRatioBits;

// Returns the ratio of the white balance factors of two channels, `recorded` / `missing`, in units
// of 1/256. It is at most kMaxRatio.
inline int32_t BalanceRatio(const std::array<double, 3>& white_balance, int recorded, int missing) {
  const double of_recorded = white_balance[static_cast<size_t>(recorded)];
  const double of_missing = white_balance[static_cast<size_t>(missing)];
  LF_CHECK(of_recorded > 0 && of_missing > 0);
  const double ratio = std::floor(of_recorded / of_missing * (1 << kRatioBits) + 0.5);
  return static_cast<int32_t>(std::min<double>(ratio, kMaxRatio));
}

// Returns `position` mirrored about the outermost pixels into [0, size); `size` is at least 2.
inline int Mirrored(int position, int size) {
  while (position < 0 || position >= size)
    position = position < 0 ? -position : 2 * (size - 1) - position;
  return position;
}

}  // namespace lf
