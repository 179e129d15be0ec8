#include "lf/collection/cubic_segments.h"

#include <algorithm>
#include <cmath>

#include "lf/collection/even_cubic.h"

namespace lf {
namespace {

// Beyond this nothing is accepted, and integers could overflow.
constexpr double kFarthest = 1 << 24;

// Bounds are this much wider: far above the rounding of single precision.
constexpr float kBoundMargin = 0.01F;

// Where cubics through four even points of [-1, 1] miss most.
constexpr double kWorstPlace = 0.745;

double ValueAt(const double (&c)[4], double t) { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; }

// The cubics of pieces [begin, end) of a row on which `position(x)`, an optional Vec2, is defined;
// pieces where they miss it are halved. `is_certain(begin, end)` spares the check.
template <class Position, class IsCertain>
class PieceFitter {
 public:
  PieceFitter(int y, const Position& position, const IsCertain& is_certain,
              std::vector<CubicSegment>* segments)
      : y_(y), position_(position), is_certain_(is_certain), segments_(segments) {}

  void Add(int x_begin, int x_end, int begin, int end) {
    Cubics cubics;
    if (Fit(begin, end, &cubics)) {
      segments_->push_back(MakeSegment(y_, x_begin, x_end, 0.5 * (begin + end), cubics));
      return;
    }
    if (end - begin == 1) return;  // there is no position
    const int split = begin + (end - begin) / 2;
    if (x_begin < split) Add(x_begin, std::min(x_end, split), begin, split);
    if (x_end > split) Add(std::max(x_begin, split), x_end, split, end);
  }

 private:
  bool Fit(int begin, int end, Cubics* cubics) {
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    if (end - begin == 1) {
      const std::optional<Vec2> p = position_(middle);
      if (p) *cubics = {{p->x(), 0, 0, 0}, {p->y(), 0, 0, 0}};
      return p.has_value();
    }
    double x[4], y[4];
    for (int i = 0; i < 4; ++i) {
      const std::optional<Vec2> p = position_(middle + half * (2 * i - 3) / 3);
      if (!p) return false;
      x[i] = p->x();
      y[i] = p->y();
    }
    InterpolateEven(x, half, cubics->x);
    InterpolateEven(y, half, cubics->y);
    if (!IsNearMiddle(*cubics, half)) return false;
    if (is_certain_(begin, end)) return true;
    for (const double u : {-kWorstPlace, kWorstPlace}) {
      const std::optional<Vec2> truth = position_(middle + u * half);
      if (!truth || !(std::abs(ValueAt(cubics->x, u * half) - truth->x()) +
                          std::abs(ValueAt(cubics->y, u * half) - truth->y()) <=
                      CubicSegments::kTolerance))
        return false;
    }
    return true;
  }

  int y_;
  const Position& position_;
  const IsCertain& is_certain_;
  std::vector<CubicSegment>* segments_;
};

}  // namespace

bool IsNearMiddle(const Cubics& cubics, double half) {
  return std::max(std::abs(cubics.x[1]), std::abs(cubics.y[1])) * half <=
         CubicSegments::kFarthestFromMiddle;
}

CubicSegment MakeSegment(int y, int x_begin, int x_end, double middle, const Cubics& cubics) {
  CubicSegment segment;
  segment.y = y;
  segment.x_begin = x_begin;
  segment.count = x_end - x_begin;
  segment.t_begin = static_cast<float>(x_begin + 0.5 - middle);
  const double base_x = std::floor(std::clamp(cubics.x[0], -kFarthest, kFarthest));
  const double base_y = std::floor(std::clamp(cubics.y[0], -kFarthest, kFarthest));
  segment.base_x = static_cast<int32_t>(base_x);
  segment.base_y = static_cast<int32_t>(base_y);
  for (int power = 0; power < 4; ++power) {
    segment.x_cubic[power] = static_cast<float>(cubics.x[power] - (power == 0 ? base_x : 0));
    segment.y_cubic[power] = static_cast<float>(cubics.y[power] - (power == 0 ? base_y : 0));
  }
  return segment;
}

void CubicSegments::Add(int y, int x_begin, int x_end, std::vector<CubicSegment>* segments) const {
  for (int x = x_begin; x < x_end;) {
    const int block = x & ~(CubicSegment::kMaxCount - 1);
    const int end = std::min(x_end, block + CubicSegment::kMaxCount);
    AddInBlock(y, x, end, block, CubicSegment::kMaxCount, segments);
    x = end;
  }
}

// With distance t from the middle of the block, and denominator d_0 + d_1 t, the position is
//   e(t) = (n_0 + n_1 t) / (d_0 + d_1 t) = e_0 + s t / (1 + q t),  q = d_1 / d_0,
//   s = (n_1 - e_0 d_1) / d_0:  a geometric series, whose fourth term is spread over the others as
//   Chebyshev's polynomial T_4 says.
void CubicSegments::AddInBlock(int y, int x_begin, int x_end, int block_begin, int block_size,
                               std::vector<CubicSegment>* segments) const {
  const double half = 0.5 * block_size, middle = block_begin + half;
  const Vec3 p(middle, y + 0.5, 1);
  const double inverse = 1 / Value(denominator_, p);
  const double q = denominator_[0] * inverse;
  const double e[2] = {Value(x_, p) * inverse, Value(y_, p) * inverse};
  const double s[2] = {x_[0] * inverse - e[0] * q, y_[0] * inverse - e[1] * q};
  const double reach = std::abs(q) * half, half4 = half * half * half * half;
  const double fourth = std::max(std::abs(s[0]), std::abs(s[1])) * std::abs(q * q * q) * half4;
  // Written so that what is not a number is not good.
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
  Cubics cubics;
  for (const int axis : {0, 1}) {
    double(&c)[4] = axis == 0 ? cubics.x : cubics.y;
    c[0] = e[axis];
    if (block_size == 1) continue;
    const double c4 = -s[axis] * q * q * q;
    c[0] -= c4 * half4 / 8;
    c[1] = s[axis];
    c[2] = -s[axis] * q + c4 * half * half;
    c[3] = s[axis] * q * q;
  }
  segments->push_back(MakeSegment(y, x_begin, x_end, middle, cubics));
}

void CubicSegments::AddOnArc(int y, int x_begin, int x_end, const IdealArc& arc,
                             std::vector<CubicSegment>* segments) const {
  const double step = 1.0 / (arc.x_end - arc.x_begin);
  const auto at = [&](double x) { return arc.At((x - arc.x_begin) * step); };
  const auto position = [&](double x) -> std::optional<Vec2> {
    const Vec3 p = at(x);
    const double inverse = 1 / Value(denominator_, p);
    return Vec2(Value(x_, p) * inverse, Value(y_, p) * inverse);
  };
  // The arc itself is a cubic: only perspective can bend it further.
  const auto is_certain = [&](int begin, int end) {
    const double first = Value(denominator_, at(begin)), last = Value(denominator_, at(end));
    return std::abs(last - first) < 1e-2 * std::abs(first);
  };
  PieceFitter(y, position, is_certain, segments).Add(x_begin, x_end, arc.x_begin, arc.x_end);
}

void CubicSegments::AddOfFunction(int y, int x_begin, int x_end, const Function& position,
                                  std::vector<CubicSegment>* segments) {
  const auto is_certain = [](int, int) { return false; };
  PieceFitter fitter(y, position, is_certain, segments);
  constexpr int kBlock = 128;
  for (int x = x_begin; x < x_end;) {
    const int block = x & ~(kBlock - 1);
    const int end = std::min(x_end, block + kBlock);
    fitter.Add(x, end, block, block + kBlock);
    x = end;
  }
}

// From the chord: the cubic strays from it by w^2 / 8 times the most of its second derivative, at
// most, and its slope changes by w times that.
CubicRange RangeOf(const float (&c)[4], float t_begin, int count) {
  const auto w = static_cast<float>(count - 1);
  const float t_end = t_begin + w;
  const float bend =
      2 * std::abs(c[2]) + 6 * std::abs(c[3]) * std::max(std::abs(t_begin), std::abs(t_end));
  const float first = ((c[3] * t_begin + c[2]) * t_begin + c[1]) * t_begin + c[0];
  const float last = ((c[3] * t_end + c[2]) * t_end + c[1]) * t_end + c[0];
  const float stray = w * w * 0.125F * bend + kBoundMargin;
  const float slope = (3 * c[3] * t_begin + 2 * c[2]) * t_begin + c[1];
  return {std::min(first, last) - stray, std::max(first, last) + stray, slope - w * bend,
          slope + w * bend};
}

}  // namespace lf
