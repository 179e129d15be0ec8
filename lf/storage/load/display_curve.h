// SPDX-License-Identifier: Apache-2.0
// Maps stored values of linear light to the tone curve of a display (IEC 61966-2-1). Lossy encoding
// works on the mapped values, because on this curve an error is equally visible in shadows and in
// highlights, and photon noise is nearly constant.
#pragma once

#include <cstdint>
#include <vector>

namespace lf {

class DisplayCurve {
 public:
  // The levels are stored values of 16 bits; white must be above black. Below black the curve
  // continues as a straight line. Above white it continues by the sRGB formula.
  DisplayCurve(double black_level, double white_level);

  uint16_t OnCurve(uint16_t stored) const { return on_curve_[stored]; }
  // Returns the stored value nearest to a position on the curve.
  uint16_t Stored(uint16_t on_curve) const { return stored_[on_curve]; }
  // Returns 1 / 255 of the distance between black and white on the curve.
  double grey_step() const { return grey_step_; }

 private:
  std::vector<uint16_t> on_curve_;
  std::vector<uint16_t> stored_;
  double grey_step_ = 1;
};

}  // namespace lf
