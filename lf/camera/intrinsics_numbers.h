// SPDX-License-Identifier: Apache-2.0
// Intrinsics as a list of numbers, for code that stores or compares them.
#pragma once

#include <array>
#include <cstddef>

#include "lf/camera/pinhole.h"

namespace lf {

inline constexpr size_t kIntrinsicsNumbers = 7;

// Returns f_x, f_y, c_x, c_y, skew, width and height, in pixels; leaves out distortion and
// vignetting.
inline std::array<double, kIntrinsicsNumbers> NumbersOfIntrinsics(const Intrinsics& k) {
  return {k.fx_px,
          k.fy_px,
          k.cx_px,
          k.cy_px,
          k.skew_px,
          static_cast<double>(k.width_px),
          static_cast<double>(k.height_px)};
}

}  // namespace lf
