// SPDX-License-Identifier: Apache-2.0
// Cuts spans of a row of pixels into segments. Along each segment, a polynomial maps the pixels to
// the positions of their rays on the plate. For the estimator *bilinear*, segments consist of
// elements, and the polynomials map them to positions in the LF image. Kernels evaluate the
// polynomials; other code only passes segments on.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/core/geometry.h"

namespace lf {

// Pixels (or elements) [x_begin, x_begin + count) of row y. With t = i + t_begin (exact in single
// precision), pixel x_begin + i is mapped to the position with the x-coordinate
//   base_x + (((x_poly[5] t + x_poly[4]) t + x_poly[3]) t + ...) t + x_poly[0]
// and with the y-coordinate that base_y and y_poly give in the same way. x_poly[0] is in [0, 1), so
// that the error of single precision is at most 1e-4. Perspective alone leads to cubics; lens
// distortion needs the higher powers.
struct Segment {
  // Largest `count`. The buffers of the kernels have this size.
  static constexpr int kMaxCount = 1024;
  static constexpr int kTerms = 6;
  // Number of positions that a parabola may replace. The x of the first of them is a multiple of
  // it.
  static constexpr int kParabola = 16;
  static constexpr double kParabolaTolerance = 1e-5;

  int32_t y = 0;
  int32_t x_begin = 0;
  int32_t count = 0;
  float t_begin = 0;
  int32_t base_x = 0;
  int32_t base_y = 0;
  // True if parabolas may replace the polynomials, with an error of at most kParabolaTolerance
  // elements (or LF pixels) along each axis, anywhere on the piece that the segment is from. Only
  // the estimator *bilinear* reads it.
  bool has_parabolas = false;
  float x_poly[kTerms] = {};
  float y_poly[kTerms] = {};

  bool is_cubic() const {
    return x_poly[5] == 0 && x_poly[4] == 0 && y_poly[5] == 0 && y_poly[4] == 0;
  }
};

// The coordinates of a position as polynomials of t, the distance of a pixel's (or element's)
// centre from the middle of a piece of a row. [k] is the coefficient of t^k.
struct Polynomials {
  double x[Segment::kTerms] = {};
  double y[Segment::kTerms] = {};
};

// Appends the segment of pixels (or elements) [x_begin, x_end) of row y, made from the polynomials
// of a piece that contains them and whose middle is at the continuous coordinate x = `middle`.
void AppendSegment(int y, int x_begin, int x_end, double middle, const Polynomials& polynomials,
                   bool has_parabolas, std::vector<Segment>* segments);

// True if Segment::has_parabolas may be true for the segments of a piece. The piece extends by
// `half` pixels (or elements) to both sides of its middle. The polynomials may also be upper bounds
// of the absolute values of the coefficients of several pieces.
bool AllowParabolas(const Polynomials& polynomials, double half);

// True if no coordinate of a position on the piece differs by more than
// SegmentMaker::kFarthestFromMiddle from the same coordinate of the position at the middle of the
// piece. The piece extends by `half` pixels (or elements) to both sides of its middle. The test
// adds up absolute values, and may therefore be false although no coordinate differs that much.
bool IsNearMiddle(const Polynomials& polynomials, double half);

// Makes the segments of rows. A pixel with the centre p = (column + 0.5, row + 0.5, 1), or with the
// ideal position p, is mapped to the position (x p, y p) / (denominator p) by the three linear
// forms x, y and denominator.
class SegmentMaker {
 public:
  // Largest error of positions, in elements (or LF pixels), before polynomials are rounded to
  // single precision.
  static constexpr double kTolerance = 1e-5;
  // Largest difference of a piece's positions from the position of its middle, in elements (or LF
  // pixels), along each axis. Rounding of coefficients, products and sums to single precision then
  // changes a position by at most 9.5e-5.
  static constexpr double kFarthestFromMiddle = 530;

  SegmentMaker(const PixelForm& x, const PixelForm& y, const PixelForm& denominator)
      : x_(x), y_(y), denominator_(denominator) {}

  // Appends the segments of [x_begin, x_end) of row y. The polynomials of each segment are fitted
  // to a block [k 2^n, (k + 1) 2^n) that contains it, so that positions do not depend on x_begin
  // and x_end.
  void Add(int y, int x_begin, int x_end, std::vector<Segment>* segments) const;

  // Like Add(), but maps the ideal positions of `arc`, the arc of scanline y, which must contain
  // [x_begin, x_end), and never sets Segment::has_parabolas. The polynomials are fitted to the arc,
  // or to halves, quarters ... of it.
  void AddOnArc(int y, int x_begin, int x_end, const IdealArc& arc,
                std::vector<Segment>* segments) const;

  // Like Add(), but `position`, which must be smooth, returns the position for the continuous
  // coordinate x along row y. The polynomials are fitted to the block [block_begin, block_end),
  // which must contain the pixels, or to halves, quarters ... of it. Pixels for which `position`
  // returns none are left out.
  using Function = std::function<std::optional<Vec2>(double x)>;
  static void AddOfFunction(int y, int x_begin, int x_end, int block_begin, int block_end,
                            const Function& position, std::vector<Segment>* segments);

 private:
  void AddInBlock(int y, int x_begin, int x_end, int block_begin, int block_size,
                  std::vector<Segment>* segments) const;

  PixelForm x_, y_, denominator_;
};

// Evaluates a polynomial by Horner's rule, as kernels do.
inline float PositionAt(const float (&polynomial)[Segment::kTerms], float t) {
  const auto& c = polynomial;
  float value = c[3];
  if (c[4] != 0 || c[5] != 0) value += (c[5] * t + c[4]) * t;
  return ((value * t + c[2]) * t + c[1]) * t + c[0];
}

// Bounds of one coordinate of a segment's positions, counted from the base, and of the change of
// this coordinate from one position to the next. The bounds are a little wider than necessary.
struct PositionRange {
  float low, high;
  float least_step, most_step;
  float first, last;  // the coordinate of the first and of the last position
};
PositionRange RangeOf(const float (&polynomial)[Segment::kTerms], float t_begin, int count);

}  // namespace lf
