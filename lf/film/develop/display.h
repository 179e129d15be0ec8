// SPDX-License-Identifier: Apache-2.0
// Converts linear light to sRGB display values and back (IEC 61966-2-1).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace lf {

// Linear and display values are in [0, 1] between black and white. The formulas are also used
// outside of this range.
inline double DisplayFromLinear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
inline double LinearFromDisplay(double display) {
  return display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4);
}

// Returns the 8-bit display value nearest to a linear value, clipped; 0 for NaN. The value is
// exact, because the linear value is compared with the linear values of the half-way points between
// display values.
class Display8 {
 public:
  Display8() {
    for (int i = 0; i < 255; ++i)
      above_[i] = static_cast<float>(LinearFromDisplay((i + 0.5) / 255));
    above_[255] = INFINITY;
    for (int cell = 0, value = 0; cell < kCells; ++cell) {
      while (above_[value] <= static_cast<float>(cell) / kCells) ++value;
      first_[cell] = static_cast<uint8_t>(value);
    }
  }

  uint8_t operator()(float linear) const {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    uint8_t value = first_[static_cast<int>(linear * kCells)];
    // Runs at most once, because a cell is narrower than the difference of two values of above_.
    while (above_[value] <= linear) ++value;
    return value;
  }

 private:
  static constexpr int kCells = 4096;
  std::array<float, 256> above_;  // [i] smallest linear value whose display value is i + 1
  // Display value at the beginning of each of the kCells cells that divide [0, 1].
  std::array<uint8_t, kCells> first_;
};

}  // namespace lf
