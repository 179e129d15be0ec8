#include "lf/collection/ray_segments.h"

#include <algorithm>
#include <cmath>

namespace lf {
namespace {

// Longer blocks would cost single precision too many bits.
constexpr int kLargestBlock = 512;

// Beyond this nothing can be accepted, and integers could overflow.
constexpr double kFarthestElement = 1 << 24;

// Bounds are kept this much wider, far above the rounding of single precision.
constexpr double kBoundMargin = 0.01;

// Least and largest value of a cubic on [t_begin, t_end]: between its Bernstein coefficients there.
struct Range {
  double low;
  double high;
};
Range RangeOf(const double (&c)[4], double t_begin, double t_end) {
  const double w = t_end - t_begin;
  const auto value = [&](double t) { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; };
  const auto slope = [&](double t) { return (3 * c[3] * t + 2 * c[2]) * t + c[1]; };
  const double b0 = value(t_begin), b3 = value(t_end);
  const double b1 = b0 + slope(t_begin) * w / 3, b2 = b3 - slope(t_end) * w / 3;
  return {std::min(std::min(b0, b1), std::min(b2, b3)),
          std::max(std::max(b0, b1), std::max(b2, b3))};
}

// The least absolute slope on [t_begin, t_end], or 0 if it may change its sign.
double LeastSlope(const double (&c)[4], double t_begin, double t_end) {
  const double w = t_end - t_begin;
  const auto slope = [&](double t) { return (3 * c[3] * t + 2 * c[2]) * t + c[1]; };
  const double b0 = slope(t_begin), b2 = slope(t_end);
  const double b1 = b0 + (6 * c[3] * t_begin + 2 * c[2]) * w / 2;
  const double low = std::min(b0, std::min(b1, b2)), high = std::max(b0, std::max(b1, b2));
  return std::max(0.0, std::max(low, -high));
}

}  // namespace

SegmentMaker::SegmentMaker(const RayForms& forms, int plate_width, int plate_height)
    : forms_(forms) {
  plan_.plate_width = plate_width;
  plan_.plate_height = plate_height;
}

void SegmentMaker::AddSpan(int y, int x_begin, int x_end) {
  for (int x = x_begin; x < x_end;) {
    const int block = x & ~(kLargestBlock - 1);
    const int end = std::min(x_end, block + kLargestBlock);
    AddInBlock(y, x, end, block, kLargestBlock);
    x = end;
  }
}

// With distance t from the middle of the block, and d = front_0 + front_1 t,
//   e(t) = (n_0 + n_1 t) / d = e_0 + s t / (1 + q t),  s = (n_1 - e_0 front_1) / front_0,
//   q = front_1 / front_0:  a geometric series, whose fourth term is spread over the others as
//   Chebyshev's polynomial T_4 says.
void SegmentMaker::AddInBlock(int y, int x_begin, int x_end, int block_begin, int block_size) {
  const double half = 0.5 * block_size;
  const double middle = block_begin + half;
  const Vec3 p(middle, y + 0.5, 1);
  const double inverse = 1 / Value(forms_.front, p);
  const double q = forms_.front[0] * inverse;
  const double e[2] = {Value(forms_.sensor_x, p) * inverse, Value(forms_.sensor_y, p) * inverse};
  const double s[2] = {forms_.sensor_x[0] * inverse - e[0] * q,
                       forms_.sensor_y[0] * inverse - e[1] * q};
  const double reach = std::abs(q) * half;
  const double fourth =
      std::max(std::abs(s[0]), std::abs(s[1])) * std::abs(q * q * q) * half * half * half * half;
  // Written so that what is not a number is not good.
  const bool is_good = reach < 0.5 && fourth * (0.125 + reach / (1 - reach)) <= kTolerance &&
                       std::abs(e[0]) < kFarthestElement && std::abs(e[1]) < kFarthestElement;
  if (block_size > 1 && !is_good) {
    const int half_size = block_size / 2, split = block_begin + half_size;
    if (x_begin < split) AddInBlock(y, x_begin, std::min(x_end, split), block_begin, half_size);
    if (x_end > split) AddInBlock(y, std::max(x_begin, split), x_end, split, half_size);
    return;
  }
  Cubics cubics;
  for (const int axis : {0, 1}) {
    double(&c)[4] = axis == 0 ? cubics.x : cubics.y;
    const double c4 = block_size > 1 ? -s[axis] * q * q * q : 0;
    c[0] = e[axis] - c4 * half * half * half * half / 8;
    c[1] = s[axis];
    c[2] = -s[axis] * q + c4 * half * half;
    c[3] = s[axis] * q * q;
  }
  if (block_size == 1)
    for (const int power : {1, 2, 3}) cubics.x[power] = cubics.y[power] = 0;
  Push(y, x_begin, x_end, middle, cubics);
}

void SegmentMaker::AddOnArc(int y, int x_begin, int x_end, const IdealArc& arc) {
  AddOnPart(y, x_begin, x_end, arc, arc.x_begin, arc.x_end);
}

void SegmentMaker::AddOnPart(int y, int x_begin, int x_end, const IdealArc& arc, int part_begin,
                             int part_end) {
  Cubics cubics;
  if (!FitToPart(arc, part_begin, part_end, &cubics)) {
    const int split = part_begin + (part_end - part_begin) / 2;
    if (x_begin < split) AddOnPart(y, x_begin, std::min(x_end, split), arc, part_begin, split);
    if (x_end > split) AddOnPart(y, std::max(x_begin, split), x_end, arc, split, part_end);
    return;
  }
  Push(y, x_begin, x_end, 0.5 * (part_begin + part_end), cubics);
}

bool SegmentMaker::FitToPart(const IdealArc& arc, int part_begin, int part_end,
                             Cubics* cubics) const {
  const double step = 1.0 / (arc.x_end - arc.x_begin);
  const double middle = 0.5 * (part_begin + part_end), half = 0.5 * (part_end - part_begin);
  struct Position {
    double x, y, front;
  };
  // u from -1 to 1 on the part.
  const auto position = [&](double u) -> Position {
    const Vec3 p = arc.At((middle + u * half - arc.x_begin) * step);
    const double front = Value(forms_.front, p);
    return {Value(forms_.sensor_x, p) / front, Value(forms_.sensor_y, p) / front, front};
  };
  if (part_end - part_begin == 1) {
    const Position p = position(0);
    *cubics = {{p.x, 0, 0, 0}, {p.y, 0, 0, 0}};
    return true;
  }
  const Position p[4] = {position(-1), position(-1.0 / 3), position(1.0 / 3), position(1)};
  const auto cubic_of = [half](double e0, double e1, double e2, double e3, double(&c)[4]) {
    c[0] = (9 * (e1 + e2) - (e0 + e3)) / 16;
    c[1] = (27 * (e2 - e1) - (e3 - e0)) / 16 / half;
    c[2] = 9 * ((e0 + e3) - (e1 + e2)) / 16 / (half * half);
    c[3] = 9 * ((e3 - e0) - 3 * (e2 - e1)) / 16 / (half * half * half);
  };
  cubic_of(p[0].x, p[1].x, p[2].x, p[3].x, cubics->x);
  cubic_of(p[0].y, p[1].y, p[2].y, p[3].y, cubics->y);
  const auto [least, most] = std::minmax({p[0].front, p[1].front, p[2].front, p[3].front});
  if (!(least * most > 0)) return false;
  if (most - least < 1e-2 * std::abs(p[0].front)) return true;
  // In strong perspective: true where a cubic through four even points misses most?
  for (const double u : {-0.745, 0.745}) {
    const Position truth = position(u);
    const double t = u * half;
    const auto value = [t](const double(&c)[4]) {
      return ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
    };
    if (!(std::abs(value(cubics->x) - truth.x) + std::abs(value(cubics->y) - truth.y) <=
          kTolerance))
      return false;
  }
  return true;
}

void SegmentMaker::Push(int y, int x_begin, int x_end, double middle, const Cubics& cubics) {
  RaySegment segment;
  segment.y = y;
  segment.x_begin = x_begin;
  segment.count = x_end - x_begin;
  const double t_begin = x_begin + 0.5 - middle, t_end = x_end - 0.5 - middle;
  segment.t_begin = static_cast<float>(t_begin);
  const Range x = RangeOf(cubics.x, t_begin, t_end), rows = RangeOf(cubics.y, t_begin, t_end);
  const int x_last = plan_.plate_width - 1, y_last = plan_.plate_height - 1;
  // As the kernel clamps.
  const auto element = [](double position, int last) {
    return static_cast<int>(std::clamp<double>(std::floor(position), 0, last));
  };
  segment.elements = {
      element(x.low - kBoundMargin, x_last), element(rows.low - kBoundMargin, y_last),
      element(x.high + kBoundMargin, x_last) + 1, element(rows.high + kBoundMargin, y_last) + 1};
  const double slope =
      std::max(LeastSlope(cubics.x, t_begin, t_end), LeastSlope(cubics.y, t_begin, t_end));
  const double crowd = slope > 1e-6 ? 2 + (1 + kBoundMargin) / slope : segment.count;
  segment.crowd = static_cast<uint32_t>(std::min<double>(segment.count, crowd));
  const double base_x = std::floor(std::clamp(cubics.x[0], -kFarthestElement, kFarthestElement));
  const double base_y = std::floor(std::clamp(cubics.y[0], -kFarthestElement, kFarthestElement));
  segment.element_x = static_cast<int32_t>(base_x);
  segment.element_y = static_cast<int32_t>(base_y);
  for (int power = 0; power < 4; ++power) {
    segment.x_cubic[power] = static_cast<float>(cubics.x[power] - (power == 0 ? base_x : 0));
    segment.y_cubic[power] = static_cast<float>(cubics.y[power] - (power == 0 ? base_y : 0));
  }
  if (plan_.segments.size() % ScatterPlan::kBlock == 0) plan_.block_elements.emplace_back();
  PixelRect& block = plan_.block_elements.back();
  block = Bounds(block, segment.elements);
  plan_.segments.push_back(segment);
}

ScatterPlan SegmentMaker::Take() { return std::move(plan_); }

}  // namespace lf
