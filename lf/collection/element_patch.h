// Polynomials along the scanlines of a patch of ideal positions, which give the positions on the
// plate, all from one fit. Internal to collection.
#pragma once

#include <optional>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/segments.h"
#include "lf/core/geometry.h"

namespace lf {

class ElementPatch {
 public:
  // Fits a polynomial through six by six points of columns [x_begin, x_end) of `patch`. None if it
  // misses positions between them, or reaches too far for single precision.
  static std::optional<ElementPatch> Fit(const PixelForm& x, const PixelForm& y,
                                         const PixelForm& denominator, const IdealPatch& patch,
                                         int x_begin, int x_end);

  int x_begin() const { return x_begin_; }
  int x_end() const { return x_end_; }

  // Appends the segment of pixels [x_begin, x_end) of scanline y.
  void Append(int y, int x_begin, int x_end, std::vector<Segment>* segments) const;

 private:
  static constexpr int kTerms = Segment::kTerms;

  Polynomials AlongRow(double s) const;

  int x_begin_ = 0, x_end_ = 0;
  double middle_x_ = 0, middle_y_ = 0;
  // Coefficients of t^k s^l, with t and s the distances from the middle along and across.
  double x_[kTerms][kTerms];
  double y_[kTerms][kTerms];
};

}  // namespace lf
