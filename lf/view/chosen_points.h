// SPDX-License-Identifier: Apache-2.0
// Rules that all readers of depth files share. Internal to this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lf/core/random.h"

namespace lf {

// The colour of points whose file states none, sRGB.
inline constexpr uint8_t kColourless = 160;

// Returns true if two lengths of a world unit mean the same.
inline bool IsSameUnit(double a_m, double b_m) {
  constexpr double kRounding = 1e-3;
  return std::abs(a_m / b_m - 1) < kRounding;
}

// Chooses one of each step() points in a row at random: every column of a depth map, whatever its
// width, has the same chance. The choice is the same each time.
class ChosenPoints {
 public:
  //   count  number of points, at least 1
  //   most   largest number of chosen points, at least 1
  ChosenPoints(size_t count, size_t most) : count_(count), step_((count + most - 1) / most) {}

  size_t step() const { return step_; }
  // Returns true if the next point is chosen. The first call is about the first point.
  bool TakesNext() {
    const size_t group = next_ / step_, begin = group * step_;
    if (next_ == begin) chosen_ = begin + RandomBits(0, 0, group) % std::min(step_, count_ - begin);
    return next_++ == chosen_;
  }

 private:
  const size_t count_, step_;
  size_t next_ = 0, chosen_ = 0;
};

// Returns the confidence as the page gets it: 255 stands for 1.
inline uint8_t ByteOfConfidence(double confidence) {
  return static_cast<uint8_t>(std::lround(255 * confidence));
}

}  // namespace lf
