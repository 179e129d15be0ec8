// Stored values of linear light on their way through a code with losses: along the curve of a
// display (IEC 61966-2-1), on which an error is as visible in shadows as in light, and the noise of
// photons is about the same everywhere.
#pragma once

#include <cstdint>
#include <vector>

namespace lf {

class DisplayCurve {
 public:
  // Levels of stored values of 16 bits; white above black. Below black the curve goes on straight,
  // above white as it is.
  DisplayCurve(double black_level, double white_level);

  uint16_t OnCurve(uint16_t stored) const { return on_curve_[stored]; }
  // The stored value nearest to a place on the curve.
  uint16_t Stored(uint16_t on_curve) const { return stored_[on_curve]; }
  // How far 1 / 255 of what is between black and white is on the curve.
  double grey_step() const { return grey_step_; }

 private:
  std::vector<uint16_t> on_curve_;
  std::vector<uint16_t> stored_;
  double grey_step_ = 1;
};

}  // namespace lf
