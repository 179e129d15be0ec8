// Along a row of pixels or elements, where rays lead is a cubic: spans cut into segments with their
// polynomials. Kernels evaluate them; callers only hand them on.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/core/geometry.h"

namespace lf {

// Positions [x_begin, x_begin + count) of row y. That with index i leads, with t = i + t_begin
// (exact in single precision), to
//   base_x + ((x_cubic[3] t + x_cubic[2]) t + x_cubic[1]) t + x_cubic[0]    and likewise y,
// where x_cubic[0] is in [0, 1): single precision holds it to 1e-4.
struct CubicSegment {
  // Of the kernels' buffers.
  static constexpr int kMaxCount = 1024;

  int32_t y = 0;
  int32_t x_begin = 0;
  int32_t count = 0;
  float t_begin = 0;
  int32_t base_x = 0;
  int32_t base_y = 0;
  float x_cubic[4] = {};
  float y_cubic[4] = {};
};

// Position over the distance t from the middle of a piece of a row.
struct Cubics {
  double x[4] = {};
  double y[4] = {};
};

// Positions [x_begin, x_end) of row y on the cubics of a piece with this middle.
CubicSegment MakeSegment(int y, int x_begin, int x_end, double middle, const Cubics& cubics);

// Whether the positions of a piece with these cubics, `half` to both sides of its middle, are no
// further from it than CubicSegments::kFarthestFromMiddle.
bool IsNearMiddle(const Cubics& cubics, double half);

// Makes the segments of rows where (x p, y p) / (denominator p) is the position for
// p = (x + 0.5, y + 0.5, 1), or any ideal position.
class CubicSegments {
 public:
  // Cubics are true to this before they are rounded to single precision.
  static constexpr double kTolerance = 1e-5;
  // How far positions of a piece may lie from its middle: single precision, rounding coefficient,
  // product and sum, then holds them to 9.5e-5.
  static constexpr double kFarthestFromMiddle = 530;

  CubicSegments(const PixelForm& x, const PixelForm& y, const PixelForm& denominator)
      : x_(x), y_(y), denominator_(denominator) {}

  // Appends those of [x_begin, x_end) of row y. They are pieces of blocks [k 2^n, (k + 1) 2^n), so
  // that no cut of the work changes a position.
  void Add(int y, int x_begin, int x_end, std::vector<CubicSegment>* segments) const;

  // The same on an arc of scanline y.
  void AddOnArc(int y, int x_begin, int x_end, const IdealArc& arc,
                std::vector<CubicSegment>* segments) const;

  // The same of any smooth function of the continuous position along row y.
  using Function = std::function<std::optional<Vec2>(double x)>;
  static void AddOfFunction(int y, int x_begin, int x_end, const Function& position,
                            std::vector<CubicSegment>* segments);

 private:
  void AddInBlock(int y, int x_begin, int x_end, int block_begin, int block_size,
                  std::vector<CubicSegment>* segments) const;

  PixelForm x_, y_, denominator_;
};

// Where one coordinate of a segment's positions lies, counted from the base and a little wider than
// it does, and how far it moves from one position to the next.
struct CubicRange {
  float low, high;
  float least_step, most_step;
};
CubicRange RangeOf(const float (&cubic)[4], float t_begin, int count);

}  // namespace lf
