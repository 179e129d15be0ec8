// Which rays of a scanline are accepted, in closed form (doc/ray.md, "Spans").
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lf/collection/plan_on_arcs.h"
#include "lf/collection/ray_law.h"
#include "lf/collection/ray_segments.h"
#include "lf/collection/scatter.h"
#include "lf/core/check.h"

namespace lf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Candidate intervals reach this far beyond the exact conditions, relative to the largest value a
// form takes on the scanline; the law then confirms every end. Far above rounding, far below a
// pixel.
constexpr double kFormMargin = 1e-9;
constexpr double kLensMargin = 1e-7;

// Real interval of pixel positions, [begin, end]; empty if end < begin.
struct Interval {
  double begin = -kInfinity;
  double end = kInfinity;
  bool empty() const { return !(begin <= end); }
};

Interval Intersect(const Interval& a, const Interval& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

// A form along one scanline: slope x + constant.
struct LineForm {
  double slope = 0;
  double constant = 0;
  double At(double x) const { return slope * x + constant; }
};

LineForm Along(const PixelForm& form, double y) { return {form[0], form[1] * y + form[2]}; }

// Candidates of form <= 0 within `range`; `tie` is set where the form stays at 0 all along, so
// that rounding alone decides each pixel.
Interval AtMostZero(const LineForm& form, const Interval& range, bool* tie) {
  const double magnitude =
      std::abs(form.slope) * std::max(std::abs(range.begin), std::abs(range.end)) +
      std::abs(form.constant);
  const double margin = kFormMargin * magnitude;
  if (std::abs(form.At(range.begin)) <= margin && std::abs(form.At(range.end)) <= margin) {
    *tie = true;
    return range;
  }
  const double bound = (margin - form.constant) / form.slope;
  if (form.slope > 0) return Intersect(range, {-kInfinity, bound});
  if (form.slope < 0) return Intersect(range, {bound, kInfinity});
  return form.constant <= margin ? range : Interval{1, 0};
}

// Candidates of right^2 + up^2 <= radius^2 forward^2 within `range`, where forward >= 0: the cut of
// a line with a convex cone, one interval. The quadratic's leading coefficient has either sign.
Interval WithinDisk(const LineForm& right, const LineForm& up, const LineForm& forward,
                    double radius, const Interval& range) {
  const double r2 = radius * radius * (1 + kLensMargin);
  // a x^2 + 2 b x + c <= 0
  const double a =
      right.slope * right.slope + up.slope * up.slope - r2 * forward.slope * forward.slope;
  const double b =
      right.slope * right.constant + up.slope * up.constant - r2 * forward.slope * forward.constant;
  const double c = right.constant * right.constant + up.constant * up.constant -
                   r2 * forward.constant * forward.constant;
  const double discriminant = b * b - a * c;
  const auto inside = [&](double x) { return (a * x + 2 * b) * x + c <= 0; };
  if (!(discriminant > 0)) return inside(0.5 * (range.begin + range.end)) ? range : Interval{1, 0};
  // Both roots without cancellation.
  const double t = -(b + std::copysign(std::sqrt(discriminant), b));
  if (a == 0)
    return Intersect(range, b > 0 ? Interval{-kInfinity, c / t} : Interval{c / t, kInfinity});
  const double low = std::min(c / t, t / a);
  const double high = std::max(c / t, t / a);
  if (a > 0) return Intersect(range, {low, high});
  // Outside the roots: one branch is the cone's mirror image with forward < 0, beyond `range` but
  // for rounding. Should both touch it, the hull is a candidate.
  const Interval left = Intersect(range, {-kInfinity, low});
  const Interval right_branch = Intersect(range, {high, kInfinity});
  if (left.empty()) return right_branch;
  return right_branch.empty() ? left : range;
}

class Planner {
 public:
  Planner(const PinholeCamera& lf_camera, const RenderCamera& render_camera, const PixelRect& rect)
      : law_(lf_camera, render_camera),
        render_camera_(render_camera),
        rect_(rect),
        in_lens_plane_(LiesInLensPlane(lf_camera, render_camera)),
        forms_(MakeRayForms(lf_camera, render_camera)),
        segments_(forms_, render_camera.pinhole.intrinsics.width_px,
                  render_camera.pinhole.intrinsics.height_px) {
    const bool is_disk = render_camera.aperture.blades == 0;
    for (const int side : {0, 1}) {
      half_planes_[side] = PlateHalfPlanes(forms_, render_camera, side == 0 ? -1 : 1, 0);
      if (is_disk) continue;
      const std::vector<PixelForm> lens = LensHalfPlanes(forms_, render_camera, kLensMargin);
      half_planes_[side].insert(half_planes_[side].end(), lens.begin(), lens.end());
    }
  }

  ScatterPlan Run() {
    for (int y = rect_.y_begin; y < rect_.y_end; ++y) {
      spans_.clear();
      for (const int side : {0, 1}) AddSide(y, side);
      // Two sides at most, one span each but for ties.
      std::sort(spans_.begin(), spans_.end());
      for (const auto& [begin, end] : spans_) segments_.AddSpan(y, begin, end);
    }
    return segments_.Take();
  }

 private:
  void AddSide(int y, int side) {
    const double centre_y = y + 0.5;
    Interval range{rect_.x_begin + 0.5, rect_.x_end - 0.5};
    bool tie = false;
    for (const PixelForm& form : half_planes_[side]) {
      range = AtMostZero(Along(form, centre_y), range, &tie);
      if (range.empty()) return;
    }
    // All rays of a camera in the lens plane cross it at one point: the law at the ends of the span
    // decides for them all, where the quadratic would have a double root.
    if (render_camera_.aperture.blades == 0 && !in_lens_plane_) {
      const RayForms& forms = forms_;
      range = WithinDisk(Along(forms.lens_right, centre_y), Along(forms.lens_up, centre_y),
                         Along(forms.forward, centre_y), render_camera_.aperture.radius_w, range);
      if (range.empty()) return;
    }
    int begin = std::max(rect_.x_begin, static_cast<int>(std::floor(range.begin - 0.5)) - 1);
    int end = std::min(rect_.x_end, static_cast<int>(std::ceil(range.end - 0.5)) + 2);
    const auto accepted = [&](int x) { return OnSide(x, y, side) && law_.Collect(x, y); };
    while (begin < end && !accepted(begin)) ++begin;
    while (begin < end && !accepted(end - 1)) --end;
    if (begin == end) return;
    if (!tie) {
      spans_.emplace_back(begin, end);
      return;
    }
    for (int x = begin; x < end;) {
      int stop = x;
      while (stop < end && accepted(stop)) ++stop;
      if (stop > x) spans_.emplace_back(x, stop);
      x = stop + 1;
    }
  }

  bool OnSide(int x, int y, int side) const {
    const double value = Value(forms_.plane, x + 0.5, y + 0.5);
    return side == 0 ? value < 0 : value > 0;
  }

  RayLaw law_;
  const RenderCamera& render_camera_;
  PixelRect rect_;
  bool in_lens_plane_;
  std::vector<PixelForm> half_planes_[2];
  RayForms forms_;
  SegmentMaker segments_;
  std::vector<std::pair<int, int>> spans_;  // of the scanline
};

}  // namespace

ScatterPlan PlanScatter(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                        const PixelRect& rect, const IdealPixels* ideal_pixels) {
  if (!lf_camera.intrinsics.has_distortion()) return Planner(lf_camera, render_camera, rect).Run();
  LF_CHECK(ideal_pixels != nullptr);
  return PlanScatterOnArcs(lf_camera, render_camera, rect, *ideal_pixels);
}

}  // namespace lf
