// SPDX-License-Identifier: Apache-2.0
// The depths of the pixels of one recorded LF image of a densified light field.
#pragma once

#include <cstdint>

#include "lf/core/image.h"

namespace lf {

struct LfDepths {
  static constexpr uint16_t kUnknown = 0;

  // Inverse depths along the axis of the LF camera, [height][width][1]: one number for divisor x
  // divisor LF pixels. The numbers 1 and 65535 stand for `least` and `greatest`, the numbers
  // between them are spaced evenly. Empty: no depth is known.
  Image<uint16_t> numbers;
  double least = 0;     // 1 / world unit
  double greatest = 0;  // 1 / world unit
  int divisor = 1;
};

}  // namespace lf
