// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/patch_edges.h"

#include <algorithm>
#include <cmath>

#include "lf/core/quintic.h"

namespace lf {
namespace {

constexpr size_t kControls = IdealPatch::kControls;
using Values = std::array<double, kControls>;

constexpr double kSlack_px = 0.01;

// Each step of Newton's method squares the error, so that the error is negligible after a step
// below kLastStep.
constexpr int kMaxSteps = 8;
constexpr double kLastStep = 1e-3;

struct ValueAndSlope {
  double value;
  double slope;
};

// A polynomial in powers of t, made from the values of a form at the control points of a scanline.
class Powers {
 public:
  explicit Powers(const Values& values) : c_(values) {
    // The coefficients are differences of the values, times binomial coefficients.
    constexpr double kBinomial[] = {1, 5, 10, 10, 5, 1};
    for (size_t k = 1; k < kControls; ++k)
      for (size_t i = kControls - 1; i >= k; --i) c_[i] -= c_[i - 1];
    for (size_t k = 0; k < kControls; ++k) c_[k] *= kBinomial[k];
  }
  ValueAndSlope At(double t) const {
    return {QuinticAt(c_, t),
            (((5 * c_[5] * t + 4 * c_[4]) * t + 3 * c_[3]) * t + 2 * c_[2]) * t + c_[1]};
  }

 private:
  Values c_;
};

// Searches a root by Newton's method, starting from *root, and writes it to *root. Returns true if
// the root is verified: at `slack` before and behind the root (but within [0, 1]) the function
// differs from 0 by more than `rounding`, with the sign `sign_before` before the root and the
// opposite sign behind it.
template <class Function>
bool FindRoot(const Function& at, double sign_before, double rounding, double slack, double* root) {
  for (int k = 0; k < kMaxSteps; ++k) {
    const ValueAndSlope here = at(*root);
    const double step = here.value / here.slope;
    // Written so that a step of NaN is rejected.
    if (!(std::abs(step) < 2)) {
      *root = 0.5;
      return false;
    }
    *root = std::clamp(*root - step, 0.0, 1.0);
    if (std::abs(step) < kLastStep) break;
  }
  const double before = at(std::max(0.0, *root - slack)).value;
  const double after = at(std::min(1.0, *root + slack)).value;
  return sign_before * before > rounding && sign_before * after < -rounding;
}

// Bounds of the square of the slope of a form along scanlines, and of the absolute value of its
// second derivative.
struct Slopes {
  double least_square;
  double largest_square;
  double most_bend;
};

Slopes SlopesOf(const std::array<double, kControls * kControls>& values) {
  constexpr double kDegree = kControls - 1;
  Range slope;
  double most_bend = 0;
  for (size_t j = 0; j < kControls; ++j) {
    const double* row = &values[j * kControls];
    for (size_t i = 0; i + 1 < kControls; ++i) {
      const double here = kDegree * (row[i + 1] - row[i]);
      if (i == 0 && j == 0) slope.low = slope.high = here;
      slope.low = std::min(slope.low, here);
      slope.high = std::max(slope.high, here);
      if (i + 2 < kControls)
        most_bend = std::max(
            most_bend, kDegree * (kDegree - 1) * std::abs(row[i + 2] - 2 * row[i + 1] + row[i]));
    }
  }
  return {slope.LeastSquare(), slope.LargestSquare(), most_bend};
}

}  // namespace

PatchEdges::Grid::Grid(const PixelForm& form, const Hull& hull) {
  for (size_t i = 0; i < values.size(); ++i) values[i] = Value(form, hull.control[i]);
}

PatchEdges::Values PatchEdges::Grid::Along(const BezierWeights& row) const {
  Values along{};
  for (size_t j = 0; j < kControls; ++j)
    for (size_t i = 0; i < kControls; ++i) along[i] += row[j] * values[j * kControls + i];
  return along;
}

void PatchEdges::Begin(const IdealPatch& patch) {
  hull_.emplace(patch);
  patch_ = &patch;
  slack_ = kSlack_px / patch.rect.width();
  forms_.clear();
  disk_.reset();
}

void PatchEdges::AddForm(const PixelForm& form) {
  forms_.push_back({Grid(form, *hull_), RangeOn(*hull_, form).rounding, 0.5});
}

// The disk's form, right^2 + up^2 - radius^2 forward^2, has the second derivative 2 (right'^2 +
// up'^2 - radius^2 forward'^2) plus terms with the second derivatives of right, up and forward. If
// the sum is positive on the whole patch, the form has at most two roots on each scanline.
bool PatchEdges::AddDisk(const RowSpans::Disk& disk) {
  const double r2 = disk.radius * disk.radius;
  const Range right = RangeOn(*hull_, disk.right), up = RangeOn(*hull_, disk.up);
  const Range forward = RangeOn(*hull_, disk.forward);
  Disk on_patch{Grid(disk.right, *hull_),
                Grid(disk.up, *hull_),
                Grid(disk.forward, *hull_),
                r2,
                DiskRounding(right, up, forward, disk.radius),
                {0, 1}};
  const Slopes x = SlopesOf(on_patch.right.values), y = SlopesOf(on_patch.up.values);
  const Slopes f = SlopesOf(on_patch.forward.values);
  const double straight = x.least_square + y.least_square - r2 * f.largest_square;
  const double bend =
      right.Most() * x.most_bend + up.Most() * y.most_bend + r2 * forward.Most() * f.most_bend;
  if (!(forward.low > 0 && straight > bend)) return false;
  disk_ = on_patch;
  return true;
}

std::optional<PatchEdges::Pixels> PatchEdges::Find(int y) {
  const BezierWeights row = BezierWeightsAt(patch_->Parameter(y));
  Span span;
  for (Form& form : forms_) {
    if (!Narrow(row, &form, &span)) return std::nullopt;
    if (span.empty()) break;
  }
  if (disk_ && !span.empty() && !Narrow(row, &*disk_, &span)) return std::nullopt;
  const PixelRect& rect = patch_->rect;
  if (span.empty()) return Pixels{0, -1, 0, -1};
  const auto column = [&](double t) { return t * rect.width() + rect.x_begin - 0.5; };
  Pixels pixels{column(span.begin), column(span.end), column(span.begin), column(span.end)};
  if (span.begin > 0) pixels.sure_begin += 2 * kSlack_px;
  if (span.end < 1) pixels.sure_end -= 2 * kSlack_px;
  return pixels;
}

bool PatchEdges::Narrow(const BezierWeights& row, Form* form, Span* span) const {
  const Values values = form->grid.Along(row);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*high < -form->rounding) return true;
  if (*low > form->rounding) {
    *span = {1, 0};
    return true;
  }
  // The polynomial rises (or falls) along the whole scanline if the values at its control points
  // do.
  const bool rises = values.back() > values.front();
  if (!(rises ? std::is_sorted(values.begin(), values.end())
              : std::is_sorted(values.rbegin(), values.rend())))
    return false;
  if (!(*low<-form->rounding&& * high> form->rounding)) return false;
  const Powers powers(values);
  const auto at = [&](double t) { return powers.At(t); };
  if (!FindRoot(at, rises ? -1 : 1, form->rounding, slack_, &form->root)) return false;
  if (rises)
    span->end = std::min(span->end, form->root + slack_);
  else
    span->begin = std::max(span->begin, form->root - slack_);
  return true;
}

// Narrows the span to the one interval on which the disk's form is below 0. Returns false if the
// ends of this interval cannot be verified.
bool PatchEdges::Narrow(const BezierWeights& row, Disk* disk, Span* span) const {
  const Values right_values = disk->right.Along(row), up_values = disk->up.Along(row);
  const Values forward_values = disk->forward.Along(row);
  const auto form_of = [&](double right, double up, double forward) {
    return right * right + up * up - disk->square_radius * forward * forward;
  };
  const double first = form_of(right_values.front(), up_values.front(), forward_values.front());
  const double last = form_of(right_values.back(), up_values.back(), forward_values.back());
  if (!(std::min(std::abs(first), std::abs(last)) > disk->rounding)) return false;
  if (first < 0 && last < 0) return true;
  const Powers right(right_values), up(up_values), forward(forward_values);
  const auto at = [&](double t) -> ValueAndSlope {
    const ValueAndSlope x = right.At(t), y = up.At(t), f = forward.At(t);
    return {form_of(x.value, y.value, f.value),
            2 * (x.value * x.slope + y.value * y.slope - disk->square_radius * f.value * f.slope)};
  };
  if (first > 0) {
    if (!FindRoot(at, 1, disk->rounding, slack_, &disk->roots[0])) return false;
    span->begin = std::max(span->begin, disk->roots[0] - slack_);
  }
  if (last > 0) {
    if (!FindRoot(at, -1, disk->rounding, slack_, &disk->roots[1])) return false;
    span->end = std::min(span->end, disk->roots[1] + slack_);
  }
  return true;
}

}  // namespace lf
