// SPDX-License-Identifier: Apache-2.0
// Polynomials for the positions on the plate along the scanlines of a patch of ideal positions. One
// fit yields the polynomials of all scanlines of the patch. Internal to collection.
#pragma once

#include <optional>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/segments.h"
#include "lf/core/geometry.h"

namespace lf {

class ElementPatch {
 public:
  // Fits a polynomial through the positions on the plate, (x p, y p) / (denominator p), of six by
  // six ideal positions p in columns [x_begin, x_end) of `patch`. Returns none if the polynomial
  // deviates by more than SegmentMaker::kTolerance from the positions at nine other points
  // (kQuinticWorstPlaces), or if positions are too far apart for single precision (IsNearMiddle()).
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
  // [k][l]: coefficients of t^k s^l, where t and s are the distances in pixels from (middle_x_,
  // middle_y_), along the scanline and across it.
  double x_[kTerms][kTerms];
  double y_[kTerms][kTerms];
};

}  // namespace lf
