// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/segments.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/core/quintic.h"

namespace lf {
namespace {

// Largest absolute coordinate of a position, in elements (or LF pixels). Larger ones are never
// accepted, and could overflow integers.
constexpr double kFarthest = 1 << 24;

// RangeOf() widens its bounds by this margin, in elements (or LF pixels), which is far above the
// rounding of single precision.
constexpr float kBoundMargin = 0.01F;

// Largest distance of one of Segment::kParabola positions from their middle.
constexpr double kReach = 0.5 * (Segment::kParabola - 1);

// Returns the largest integer that is not above `value`, which must fit into 32 bits. Faster than
// std::floor(), which is a function call on processors without SSE 4.1.
int32_t Floor(double value) {
  const auto whole = static_cast<int32_t>(value);
  return whole - (whole > value ? 1 : 0);
}

// Fits polynomials to the function `position(x)`, which returns an optional Vec2, on pieces [begin,
// end) of a row. A piece is halved if the polynomials are not accurate enough on it.
//   parabolas  false: Segment::has_parabolas is always false, because it will not be read
template <class Position>
class PieceFitter {
 public:
  PieceFitter(int y, const Position& position, bool parabolas, std::vector<Segment>* segments)
      : y_(y), position_(position), parabolas_(parabolas), segments_(segments) {}

  void Add(int x_begin, int x_end, int begin, int end) {
    Polynomials polynomials;
    if (Fit(begin, end, &polynomials)) {
      AppendSegment(y_, x_begin, x_end, 0.5 * (begin + end), polynomials,
                    parabolas_ && AllowParabolas(polynomials, 0.5 * (end - begin)), segments_);
      return;
    }
    if (end - begin == 1) return;  // the pixel has no position
    const int split = begin + (end - begin) / 2;
    if (x_begin < split) Add(x_begin, std::min(x_end, split), begin, split);
    if (x_end > split) Add(std::max(x_begin, split), x_end, split, end);
  }

 private:
  bool Fit(int begin, int end, Polynomials* polynomials) {
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    if (end - begin == 1) {
      const std::optional<Vec2> p = position_(middle);
      if (p) *polynomials = {{p->x()}, {p->y()}};
      return p.has_value();
    }
    std::array<Vec2, Segment::kTerms> through;
    for (size_t i = 0; i < through.size(); ++i) {
      const std::optional<Vec2> p = position_(middle + half * kQuinticPlaces[i]);
      if (!p) return false;
      through[i] = *p;
    }
    const std::array<Vec2, Segment::kTerms> powers = QuinticThrough(through);
    double scale = 1;
    for (size_t k = 0; k < powers.size(); ++k) {
      polynomials->x[k] = powers[k].x() * scale;
      polynomials->y[k] = powers[k].y() * scale;
      scale /= half;
    }
    if (!IsNearMiddle(*polynomials, half)) return false;
    for (const double u : kQuinticWorstPlaces) {
      const std::optional<Vec2> truth = position_(middle + u * half);
      if (!truth || !(std::abs(QuinticAt(polynomials->x, u * half) - truth->x()) +
                          std::abs(QuinticAt(polynomials->y, u * half) - truth->y()) <=
                      SegmentMaker::kTolerance))
        return false;
    }
    return true;
  }

  int y_;
  const Position& position_;
  bool parabolas_;
  std::vector<Segment>* segments_;
};

}  // namespace

bool IsNearMiddle(const Polynomials& polynomials, double half) {
  const auto reach = [half](const double(&c)[Segment::kTerms]) {
    double sum = 0;
    for (int power = Segment::kTerms - 1; power > 0; --power)
      sum = (sum + std::abs(c[power])) * half;
    return sum;
  };
  return std::max(reach(polynomials.x), reach(polynomials.y)) <= SegmentMaker::kFarthestFromMiddle;
}

// With the distance j from the middle of Segment::kParabola positions, at most J, a polynomial is
//   a + b j + c j^2 + d j^3 + e j^4 + f j^5.
// The parabola a + (b + 3/4 J^2 d) j + c j^2 differs by d (j^3 - 3/4 J^2 j) + e j^4 + f j^5, the
// first term of which is at most |d| J^3 / 4.
bool AllowParabolas(const Polynomials& polynomials, double half) {
  const double m = half + kReach;  // bounds t in the middle of the positions
  const auto error = [m](const double(&p)[Segment::kTerms]) {
    const double f = std::abs(p[5]), e = std::abs(p[4]) + 5 * f * m;
    const double d = std::abs(p[3]) + (4 * std::abs(p[4]) + 10 * f * m) * m;
    return ((f * kReach + e) * kReach + 0.25 * d) * (kReach * kReach * kReach);
  };
  return half >= Segment::kParabola / 2 &&
         std::max(error(polynomials.x), error(polynomials.y)) <= Segment::kParabolaTolerance;
}

// Builds the segment in the vector: a copy made right after many short stores would stall the
// processor.
void AppendSegment(int y, int x_begin, int x_end, double middle, const Polynomials& polynomials,
                   bool has_parabolas, std::vector<Segment>* segments) {
  Segment& segment = segments->emplace_back();
  segment.y = y;
  segment.x_begin = x_begin;
  segment.count = x_end - x_begin;
  segment.t_begin = static_cast<float>(x_begin + 0.5 - middle);
  segment.base_x = Floor(std::clamp(polynomials.x[0], -kFarthest, kFarthest));
  segment.base_y = Floor(std::clamp(polynomials.y[0], -kFarthest, kFarthest));
  segment.has_parabolas = has_parabolas;
  segment.x_poly[0] = static_cast<float>(polynomials.x[0] - segment.base_x);
  segment.y_poly[0] = static_cast<float>(polynomials.y[0] - segment.base_y);
  for (int power = 1; power < Segment::kTerms; ++power) {
    segment.x_poly[power] = static_cast<float>(polynomials.x[power]);
    segment.y_poly[power] = static_cast<float>(polynomials.y[power]);
  }
}

void SegmentMaker::Add(int y, int x_begin, int x_end, std::vector<Segment>* segments) const {
  for (int x = x_begin; x < x_end;) {
    const int block = x & ~(Segment::kMaxCount - 1);
    const int end = std::min(x_end, block + Segment::kMaxCount);
    AddInBlock(y, x, end, block, Segment::kMaxCount, segments);
    x = end;
  }
}

// At the distance t from the middle of the block, with the numerator n_0 + n_1 t and the
// denominator d_0 + d_1 t, a coordinate of the position is
//   e(t) = (n_0 + n_1 t) / (d_0 + d_1 t) = e_0 + s t / (1 + q t),
//   e_0 = n_0 / d_0,  q = d_1 / d_0,  s = (n_1 - e_0 d_1) / d_0.
// This is the sum of a geometric series. Its term of t^4 is replaced by lower powers with the help
// of Chebyshev's polynomial T_4.
void SegmentMaker::AddInBlock(int y, int x_begin, int x_end, int block_begin, int block_size,
                              std::vector<Segment>* segments) const {
  const double half = 0.5 * block_size, middle = block_begin + half;
  const Vec3 p(middle, y + 0.5, 1);
  const double inverse = 1 / Value(denominator_, p);
  const double q = denominator_[0] * inverse;
  const double e[2] = {Value(x_, p) * inverse, Value(y_, p) * inverse};
  const double s[2] = {x_[0] * inverse - e[0] * q, y_[0] * inverse - e[1] * q};
  const double reach = std::abs(q) * half, half4 = half * half * half * half;
  const double fourth = std::max(std::abs(s[0]), std::abs(s[1])) * std::abs(q * q * q) * half4;
  // Written so that NaN is rejected.
  const bool is_good = std::max(std::abs(s[0]), std::abs(s[1])) * half <= kFarthestFromMiddle &&
                       reach < 0.5 && fourth * (0.125 + reach / (1 - reach)) <= kTolerance &&
                       std::abs(e[0]) < kFarthest && std::abs(e[1]) < kFarthest;
  if (block_size > 1 && !is_good) {
    const int half_size = block_size / 2, split = block_begin + half_size;
    if (x_begin < split)
      AddInBlock(y, x_begin, std::min(x_end, split), block_begin, half_size, segments);
    if (x_end > split) AddInBlock(y, std::max(x_begin, split), x_end, split, half_size, segments);
    return;
  }
  Polynomials cubics;
  for (const int axis : {0, 1}) {
    double(&c)[Segment::kTerms] = axis == 0 ? cubics.x : cubics.y;
    c[0] = e[axis];
    if (block_size == 1) continue;
    const double c4 = -s[axis] * q * q * q;
    c[0] -= c4 * half4 / 8;
    c[1] = s[axis];
    c[2] = -s[axis] * q + c4 * half * half;
    c[3] = s[axis] * q * q;
  }
  // AllowParabolas(), for cubics.
  constexpr double kMostBend = 4 * Segment::kParabolaTolerance / (kReach * kReach * kReach);
  const bool has_parabolas = block_size >= Segment::kParabola &&
                             std::max(std::abs(cubics.x[3]), std::abs(cubics.y[3])) <= kMostBend;
  AppendSegment(y, x_begin, x_end, middle, cubics, has_parabolas, segments);
}

void SegmentMaker::AddOnArc(int y, int x_begin, int x_end, const IdealArc& arc,
                            std::vector<Segment>* segments) const {
  const double step = 1.0 / (arc.x_end - arc.x_begin);
  const auto position = [&](double x) -> std::optional<Vec2> {
    const Vec3 p = arc.At((x - arc.x_begin) * step);
    const double inverse = 1 / Value(denominator_, p);
    return Vec2(Value(x_, p) * inverse, Value(y_, p) * inverse);
  };
  PieceFitter(y, position, false, segments).Add(x_begin, x_end, arc.x_begin, arc.x_end);
}

void SegmentMaker::AddOfFunction(int y, int x_begin, int x_end, int block_begin, int block_end,
                                 const Function& position, std::vector<Segment>* segments) {
  PieceFitter(y, position, true, segments).Add(x_begin, x_end, block_begin, block_end);
}

// The bounds are computed from the chord between the first and the last position, whose t differ by
// w. The polynomial deviates from the chord by at most w^2 / 8 times the largest second derivative,
// and its slope changes by at most w times this derivative.
PositionRange RangeOf(const float (&c)[Segment::kTerms], float t_begin, int count) {
  const auto w = static_cast<float>(count - 1);
  const float t_end = t_begin + w, t = t_begin;
  const float far = std::max(std::abs(t_begin), std::abs(t_end));
  const float bend =
      2 * std::abs(c[2]) +
      far * (6 * std::abs(c[3]) + far * (12 * std::abs(c[4]) + far * 20 * std::abs(c[5])));
  const float first = PositionAt(c, t_begin), last = PositionAt(c, t_end);
  const float stray = w * w * 0.125F * bend + kBoundMargin;
  const float slope = (((5 * c[5] * t + 4 * c[4]) * t + 3 * c[3]) * t + 2 * c[2]) * t + c[1];
  return {std::min(first, last) - stray,
          std::max(first, last) + stray,
          slope - w * bend,
          slope + w * bend,
          first,
          last};
}

}  // namespace lf
