// Where the pixels of a patch of ideal positions lead: cubics along its scanlines, all from one
// fit. Internal to collection.
#pragma once

#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/cubic_segments.h"
#include "lf/core/geometry.h"

namespace lf {

// For patches in weak perspective, where `denominator` varies by 1 % at most: then the bicubic
// through four by four points is true to the patch.
class CubicPatch {
 public:
  CubicPatch(const PixelForm& x, const PixelForm& y, const PixelForm& denominator,
             const IdealPatch& patch);

  // Whether single precision is enough for it (cubic_segments.h).
  bool IsNearMiddle() const;

  // Pixels [x_begin, x_end) of scanline y.
  void Append(int y, int x_begin, int x_end, std::vector<CubicSegment>* segments) const;

 private:
  double middle_x_, middle_y_;
  double half_x_;
  // Coefficients of t^k s^l, with t and s the distances from the middle along and across.
  double x_[4][4];
  double y_[4][4];
};

}  // namespace lf
