// Cuts spans of a row of pixels or elements into segments, along each of which a polynomial gives
// the positions that rays lead to. Kernels evaluate the polynomials; callers only hand segments on.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/core/geometry.h"

namespace lf {

// Positions [x_begin, x_begin + count) of row y. With t = i + t_begin (exact in single precision),
// the position with index i leads to
//   base_x + ((((x_poly[5] t + x_poly[4]) t + x_poly[3]) t + ...) t + x_poly[0]   and likewise y,
// where x_poly[0] is in [0, 1), so that single precision holds it to 1e-4. Perspective alone gives
// cubics; lens distortion needs the higher powers.
struct Segment {
  // Size of the kernels' buffers.
  static constexpr int kMaxCount = 1024;
  static constexpr int kTerms = 6;

  int32_t y = 0;
  int32_t x_begin = 0;
  int32_t count = 0;
  float t_begin = 0;
  int32_t base_x = 0;
  int32_t base_y = 0;
  float x_poly[kTerms] = {};
  float y_poly[kTerms] = {};

  bool is_cubic() const {
    return x_poly[5] == 0 && x_poly[4] == 0 && y_poly[5] == 0 && y_poly[4] == 0;
  }
};

// The position as polynomials of the distance t from the middle of a piece of a row.
struct Polynomials {
  double x[Segment::kTerms] = {};
  double y[Segment::kTerms] = {};
};

// Makes the segment of positions [x_begin, x_end) of row y, from the polynomials of a piece with
// this middle.
Segment MakeSegment(int y, int x_begin, int x_end, double middle, const Polynomials& polynomials);

// True if the positions of a piece with these polynomials, which reaches `half` to both sides of
// its middle, are within SegmentMaker::kFarthestFromMiddle of the position of the middle.
bool IsNearMiddle(const Polynomials& polynomials, double half);

// Makes the segments of rows where (x p, y p) / (denominator p) is the position for
// p = (x + 0.5, y + 0.5, 1), or any ideal position.
class SegmentMaker {
 public:
  // Largest error of polynomials before they are rounded to single precision.
  static constexpr double kTolerance = 1e-5;
  // Largest distance of a piece's positions from that of its middle. Single precision, which rounds
  // coefficients, products and sums, then holds them to 9.5e-5.
  static constexpr double kFarthestFromMiddle = 530;

  SegmentMaker(const PixelForm& x, const PixelForm& y, const PixelForm& denominator)
      : x_(x), y_(y), denominator_(denominator) {}

  // Appends the segments of [x_begin, x_end) of row y. Each is a piece of a block
  // [k 2^n, (k + 1) 2^n), so that no cut of the work changes a position.
  void Add(int y, int x_begin, int x_end, std::vector<Segment>* segments) const;

  // As Add(), on an arc of scanline y.
  void AddOnArc(int y, int x_begin, int x_end, const IdealArc& arc,
                std::vector<Segment>* segments) const;

  // As Add(), for any smooth function of the continuous position along row y.
  using Function = std::function<std::optional<Vec2>(double x)>;
  static void AddOfFunction(int y, int x_begin, int x_end, const Function& position,
                            std::vector<Segment>* segments);

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

// Bounds of one coordinate of a segment's positions, counted from the base, and of its change from
// one position to the next. They are a little wider than necessary.
struct PositionRange {
  float low, high;
  float least_step, most_step;
  float first, last;  // the first and the last position
};
PositionRange RangeOf(const float (&polynomial)[Segment::kTerms], float t_begin, int count);

}  // namespace lf
