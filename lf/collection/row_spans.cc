// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/row_spans.h"

#include <cmath>
#include <limits>

namespace lf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Margins by which candidate intervals reach beyond the exact conditions; the ray model then
// decides at the ends of these intervals. kFormMargin is relative to the sum of the absolute terms
// of a form, kDiskMargin to the square of the disk's radius. Both are far above rounding errors and
// far below a pixel.
constexpr double kFormMargin = 1e-9;
constexpr double kDiskMargin = 1e-7;
constexpr double kSlack = 0.01;  // margin at the ends of intervals, in pixels

using Interval = RowSpans::Interval;
constexpr Interval kNowhere{1, 0};

Interval Intersect(const Interval& a, const Interval& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

// The smallest and the largest value of a form at the pixel centres of a rectangle. The form has
// these values at corner pixels. A value within `margin` of 0 may have the wrong sign by rounding.
struct FormRange {
  double low, high;
  double margin;
};

FormRange RangeOn(const PixelRect& rect, const PixelForm& form) {
  const double x[2] = {rect.x_begin + 0.5, rect.x_end - 0.5};
  const double y[2] = {rect.y_begin + 0.5, rect.y_end - 0.5};
  const double middle = 0.5 * (form[0] * (x[0] + x[1]) + form[1] * (y[0] + y[1])) + form[2];
  const double reach =
      0.5 * (std::abs(form[0]) * (x[1] - x[0]) + std::abs(form[1]) * (y[1] - y[0]));
  const double margin =
      kFormMargin *
      (std::abs(form[0]) * std::max(std::abs(x[0]), std::abs(x[1])) +
       std::abs(form[1]) * std::max(std::abs(y[0]), std::abs(y[1])) + std::abs(form[2]));
  return {middle - reach, middle + reach, margin};
}

// A form along one scanline: slope x + constant.
struct LineForm {
  double slope = 0;
  double constant = 0;
  double At(double x) const { return slope * x + constant; }
};

LineForm Along(const PixelForm& form, double y) { return {form[0], form[1] * y + form[2]}; }

// Returns the part of `range` where form <= 0 may hold (with a margin). Sets `tie` to true if the
// form is 0 on all of `range`, so that rounding alone would decide about each pixel. Narrows `sure`
// to positions where form <= 0 holds in spite of rounding.
Interval AtMostZero(const LineForm& form, const Interval& range, bool* tie, Interval* sure) {
  const double magnitude =
      std::abs(form.slope) * std::max(std::abs(range.begin), std::abs(range.end)) +
      std::abs(form.constant);
  const double margin = kFormMargin * magnitude;
  if (std::abs(form.At(range.begin)) <= margin && std::abs(form.At(range.end)) <= margin) {
    *tie = true;
    *sure = kNowhere;
    return range;
  }
  if (form.slope == 0) return form.constant <= margin ? range : kNowhere;
  const double inverse = 1 / form.slope, bound = (margin - form.constant) * inverse;
  const double inside = kSlack + 2 * margin * std::abs(inverse);
  if (form.slope > 0) {
    *sure = Intersect(*sure, {-kInfinity, bound - inside});
    return Intersect(range, {-kInfinity, bound});
  }
  *sure = Intersect(*sure, {bound + inside, kInfinity});
  return Intersect(range, {bound, kInfinity});
}

// Returns the part of `range` where right^2 + up^2 <= radius^2 forward^2 may hold (with a margin).
// Since `forward` has one sign there, which the half-planes fix, this is the intersection of a line
// with a convex cone: one interval. The leading coefficient of the quadratic may have either sign.
Interval WithinDisk(const LineForm& right, const LineForm& up, const LineForm& forward,
                    double radius, const Interval& range) {
  const double r2 = radius * radius * (1 + kDiskMargin);
  // The condition is a x^2 + 2 b x + c <= 0.
  const double a =
      right.slope * right.slope + up.slope * up.slope - r2 * forward.slope * forward.slope;
  const double b =
      right.slope * right.constant + up.slope * up.constant - r2 * forward.slope * forward.constant;
  const double c = right.constant * right.constant + up.constant * up.constant -
                   r2 * forward.constant * forward.constant;
  const double discriminant = b * b - a * c;
  const auto inside = [&](double x) { return (a * x + 2 * b) * x + c <= 0; };
  if (!(discriminant > 0)) return inside(0.5 * (range.begin + range.end)) ? range : kNowhere;
  // Both roots, c / t and t / a, are computed without cancellation.
  const double t = -(b + std::copysign(std::sqrt(discriminant), b));
  if (a == 0)
    return Intersect(range, b > 0 ? Interval{-kInfinity, c / t} : Interval{c / t, kInfinity});
  const double low = std::min(c / t, t / a);
  const double high = std::max(c / t, t / a);
  if (a > 0) return Intersect(range, {low, high});
  // The condition holds to the left of the smaller root and to the right of the larger one. One of
  // these two branches belongs to the mirror image of the cone, where `forward` has the other sign;
  // it is outside `range`, except for rounding errors. If both branches reach into `range`, all of
  // `range` is returned.
  const Interval left = Intersect(range, {-kInfinity, low});
  const Interval right_branch = Intersect(range, {high, kInfinity});
  if (left.empty()) return right_branch;
  return right_branch.empty() ? left : range;
}

}  // namespace

void RowSpans::RestrictTo(const PixelRect& rect) {
  if (rect.empty()) return;
  for (const int side : {0, 1}) {
    std::vector<PixelForm>& forms = half_planes[side];
    std::erase_if(forms, [&](const PixelForm& form) {
      const FormRange range = RangeOn(rect, form);
      is_shut_[side] |= range.low > range.margin;
      return range.high < -range.margin;
    });
  }
  if (!disk) return;
  const auto largest_square = [&](const PixelForm& form) {
    const FormRange range = RangeOn(rect, form);
    const double most = std::max(-range.low, range.high) + range.margin;
    return most * most;
  };
  const FormRange forward = RangeOn(rect, disk->forward);
  const double least_forward = std::max(0.0, forward.low - forward.margin);
  if (largest_square(disk->right) + largest_square(disk->up) <
      disk->radius * disk->radius * (1 - kDiskMargin) * least_forward * least_forward)
    disk.reset();
}

bool RowSpans::IsSurelyInDisk(double centre_x, double centre_y) const {
  const double right = Value(disk->right, centre_x, centre_y);
  const double up = Value(disk->up, centre_x, centre_y);
  const double rim = disk->radius * Value(disk->forward, centre_x, centre_y);
  return right * right + up * up < (1 - kDiskMargin) * rim * rim;
}

RowSpans::Candidate RowSpans::FindCandidate(int side, double centre_y, int x_begin,
                                            int x_end) const {
  Interval range{x_begin + 0.5, x_end - 0.5}, sure{-kInfinity, kInfinity};
  bool tie = false;
  for (const PixelForm& form : half_planes[side]) {
    range = AtMostZero(Along(form, centre_y), range, &tie, &sure);
    if (range.empty()) return {};
  }
  if (disk) {
    range = WithinDisk(Along(disk->right, centre_y), Along(disk->up, centre_y),
                       Along(disk->forward, centre_y), disk->radius, range);
    if (range.empty()) return {};
  }
  return {std::max(x_begin, static_cast<int>(std::ceil(range.begin - 0.5 - kSlack))),
          std::min(x_end, static_cast<int>(std::floor(range.end - 0.5 + kSlack)) + 1), tie, sure};
}

}  // namespace lf
