// SPDX-License-Identifier: Apache-2.0
// The weights of Catmull and Rom's cubic interpolation as integers, so that results are
// bit-identical everywhere. Internal to collection.
//
// The sixteen pixels p_ik lie in rows i and columns k. First, each column is mixed:
//   column_k = round((d0 p_0k + d1 p_1k + d2 p_2k + d3 p_3k) / 2^8),   d = CubicTapsAt(down, 12)
// Then the columns are mixed to the value,
//   round((c0 column_0 + c1 column_1 + c2 column_2 + c3 column_3) / 2^15)
// with c = CubicTapsAt(right, 11). The value is clipped to 16 bits. `right` and `down` are
// distances from the upper left one of the inner four pixels, in steps of 1 / kCubicSteps px. The
// value is exact if all pixels are equal. All sums fit into 32 bits if 2^15 is subtracted from p.
#pragma once

#include <array>
#include <cstdint>

namespace lf {

inline constexpr int kCubicDownBits = 12;
inline constexpr int kCubicRightBits = 11;
inline constexpr int kCubicColumnShift = 8;
inline constexpr int kCubicShift = kCubicDownBits - kCubicColumnShift + kCubicRightBits;
inline constexpr int kCubicSteps = 256;  // steps from one pixel to the next

using CubicTaps = std::array<int32_t, 4>;

// Returns the weights of pixels -1, 0, 1 and 2 for the position that is `step` / kCubicSteps of the
// way from pixel 0 to pixel 1. Their sum is 2^bits.
constexpr CubicTaps CubicTapsAt(int step, int bits) {
  const int64_t t = step, one = kCubicSteps;
  // The exact weights times 2 kCubicSteps^3.
  const std::array<int64_t, 4> exact = {-t * t * t + 2 * one * t * t - one * one * t,
                                        3 * t * t * t - 5 * one * t * t + 2 * one * one * one,
                                        -3 * t * t * t + 4 * one * t * t + one * one * t,
                                        t * t * t - one * t * t};
  const int shift = 25 - bits;
  CubicTaps taps{};
  for (int i = 0; i < 4; ++i)
    taps[i] = static_cast<int32_t>((exact[i] + (int64_t{1} << (shift - 1))) >> shift);
  // The remainder of the rounding is added to the weight of the nearer pixel.
  taps[2 * step < kCubicSteps ? 1 : 2] += (1 << bits) - (taps[0] + taps[1] + taps[2] + taps[3]);
  return taps;
}

}  // namespace lf
