#include "lf/collection/plan_on_arcs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/camera/ray_forms.h"
#include "lf/collection/ray_law.h"
#include "lf/collection/scatter_plan.h"

namespace lf {
namespace {

// Values this near to 0, relative to the terms they are summed from, may be rounding.
constexpr double kRounding = 1e-9;

enum class Share { kNone, kSome, kAll };  // of an arc's rays

Share Both(Share a, Share b) { return std::min(a, b); }

// The least and the largest value that a form can have on an arc.
struct Range {
  double low = 0;
  double high = 0;
  double rounding = 0;
};

// The control points of an arc, and how far they reach in each coordinate.
struct Hull {
  const Vec3* control;
  Vec3 reach;
  explicit Hull(const IdealArc& arc) : control(arc.control) {
    reach = control[0].cwiseAbs().cwiseMax(control[1].cwiseAbs());
    reach = reach.cwiseMax(control[2].cwiseAbs()).cwiseMax(control[3].cwiseAbs());
  }
};

Range RangeOn(const Hull& arc, const PixelForm& form) {
  const double a = Value(form, arc.control[0]), b = Value(form, arc.control[1]);
  const double c = Value(form, arc.control[2]), d = Value(form, arc.control[3]);
  return {std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d)),
          kRounding * (std::abs(form[0]) * arc.reach[0] + std::abs(form[1]) * arc.reach[1] +
                       std::abs(form[2]) * arc.reach[2])};
}

// Where form <= 0.
Share AtMostZero(const Hull& arc, const PixelForm& form) {
  const Range range = RangeOn(arc, form);
  if (range.low > range.rounding) return Share::kNone;
  return range.high < -range.rounding ? Share::kAll : Share::kSome;
}

double LeastSquare(const Range& range) {
  if (range.low <= 0 && range.high >= 0) return 0;
  return std::min(range.low * range.low, range.high * range.high);
}

double LargestSquare(const Range& range) {
  return std::max(range.low * range.low, range.high * range.high);
}

class ArcPlanner {
 public:
  ArcPlanner(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
             const PixelRect& rect, const IdealPixels& ideal_pixels)
      : law_(lf_camera, render_camera),
        render_camera_(render_camera),
        rect_(rect),
        in_lens_plane_(LiesInLensPlane(lf_camera, render_camera)),
        ideal_pixels_(ideal_pixels),
        forms_(MakeRayForms(lf_camera, render_camera)),
        cubics_(forms_.sensor_x, forms_.sensor_y, forms_.front) {
    for (const int side : {0, 1})
      plate_half_planes_[side] = PlateHalfPlanes(forms_, render_camera, side == 0 ? -1 : 1, 0);
    if (render_camera.aperture.blades > 0)
      lens_half_planes_ = LensHalfPlanes(forms_, render_camera, 0);
  }

  ScatterPlan Run() {
    for (int y = rect_.y_begin; y < rect_.y_end; ++y) {
      for (const IdealArc& arc : ideal_pixels_.Scanline(y)) AddArc(y, arc);
    }
    const Intrinsics& plate = render_camera_.pinhole.intrinsics;
    return MakeScatterPlan(segments_, plate.width_px, plate.height_px);
  }

 private:
  void AddArc(int y, const IdealArc& arc) {
    const int begin = std::max(arc.x_begin, rect_.x_begin), end = std::min(arc.x_end, rect_.x_end);
    if (begin >= end) return;
    runs_.clear();
    FindRuns(arc, arc, begin, end);
    for (const PixelRun& run : runs_) cubics_.AddOnArc(y, run.begin, run.end, arc, &segments_);
  }

  // Appends the accepted pixels of `part` of an arc, within [begin, end).
  void FindRuns(const IdealArc& part, const IdealArc& arc, int begin, int end) {
    if (part.x_begin >= end || part.x_end <= begin) return;
    const Share share = AcceptedShare(Hull(part));
    if (share == Share::kNone) return;
    if (share == Share::kAll) {
      AppendRun(std::max(begin, part.x_begin), std::min(end, part.x_end));
      return;
    }
    constexpr int kFewPixels = 4;
    if (part.x_end - part.x_begin <= kFewPixels) {
      for (int x = std::max(begin, part.x_begin); x < std::min(end, part.x_end); ++x)
        if (law_.CollectIdeal(arc.At(arc.Parameter(x)))) AppendRun(x, x + 1);
      return;
    }
    IdealArc left, right;
    Split(part, &left, &right);
    FindRuns(left, arc, begin, end);
    FindRuns(right, arc, begin, end);
  }

  // De Casteljau's construction at a border of pixels near the middle.
  static void Split(const IdealArc& arc, IdealArc* left, IdealArc* right) {
    const int middle = arc.x_begin + (arc.x_end - arc.x_begin) / 2;
    const double t = static_cast<double>(middle - arc.x_begin) / (arc.x_end - arc.x_begin);
    const auto mix = [t](const Vec3& a, const Vec3& b) -> Vec3 { return a + t * (b - a); };
    const Vec3 ab = mix(arc.control[0], arc.control[1]), bc = mix(arc.control[1], arc.control[2]);
    const Vec3 cd = mix(arc.control[2], arc.control[3]);
    const Vec3 abc = mix(ab, bc), bcd = mix(bc, cd), on_arc = mix(abc, bcd);
    *left = {arc.x_begin, middle, {arc.control[0], ab, abc, on_arc}};
    *right = {middle, arc.x_end, {on_arc, bcd, cd, arc.control[3]}};
  }

  void AppendRun(int begin, int end) {
    if (!runs_.empty() && runs_.back().end == begin)
      runs_.back().end = end;
    else
      runs_.push_back({begin, end});
  }

  Share AcceptedShare(const Hull& arc) const {
    // The two sides of n.d = 0 exclude each other.
    const Share sides = std::max(ShareOnPlate(arc, 0), ShareOnPlate(arc, 1));
    return sides == Share::kNone ? sides : Both(sides, ShareInLens(arc));
  }

  Share ShareOnPlate(const Hull& arc, int side) const {
    Share share = Share::kAll;
    for (const PixelForm& form : plate_half_planes_[side]) {
      share = Both(share, AtMostZero(arc, form));
      if (share == Share::kNone) break;
    }
    return share;
  }

  Share ShareInLens(const Hull& arc) const {
    if (render_camera_.aperture.blades > 0) {
      Share share = Share::kAll;
      for (const PixelForm& form : lens_half_planes_) {
        share = Both(share, AtMostZero(arc, form));
        if (share == Share::kNone) break;
      }
      return share;
    }
    const Range right = RangeOn(arc, forms_.lens_right);
    const Range up = RangeOn(arc, forms_.lens_up);
    const Range forward = RangeOn(arc, forms_.forward);
    if (!(forward.low > 0)) return Share::kSome;
    const double r2 = render_camera_.aperture.radius_w * render_camera_.aperture.radius_w;
    // Here lens_right = l_x forward with one l_x for all rays: the quotient is sharper.
    if (in_lens_plane_) {
      const double l2 = (LargestSquare(right) + LargestSquare(up)) /
                        std::max(forward.high * forward.high, 1e-300);
      if (l2 > r2 * (1 + kInLensPlaneMargin)) return Share::kNone;
      return l2 < r2 * (1 - kInLensPlaneMargin) ? Share::kAll : Share::kSome;
    }
    const double rounding =
        10 * kRounding * (LargestSquare(right) + LargestSquare(up) + r2 * LargestSquare(forward));
    if (LeastSquare(right) + LeastSquare(up) > r2 * LargestSquare(forward) + rounding)
      return Share::kNone;
    return LargestSquare(right) + LargestSquare(up) < r2 * LeastSquare(forward) - rounding
               ? Share::kAll
               : Share::kSome;
  }

  // Pixels [begin, end) of a scanline, accepted.
  struct PixelRun {
    int begin;
    int end;
  };

  static constexpr double kInLensPlaneMargin = 1e-6;

  RayLaw law_;
  const RenderCamera& render_camera_;
  PixelRect rect_;
  bool in_lens_plane_;
  std::vector<PixelForm> plate_half_planes_[2];
  std::vector<PixelForm> lens_half_planes_;
  const IdealPixels& ideal_pixels_;
  RayForms forms_;
  CubicSegments cubics_;
  std::vector<CubicSegment> segments_;
  std::vector<PixelRun> runs_;  // of the arc
};

}  // namespace

bool LiesInLensPlane(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  const Vec3 offset = lf_camera.CentreWorld() - render_camera.pinhole.CentreWorld();
  return std::abs(render_camera.pinhole.ForwardWorld().dot(offset)) <=
         1e-13 * (lf_camera.CentreWorld().norm() + render_camera.pinhole.CentreWorld().norm());
}

ScatterPlan PlanScatterOnArcs(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                              const PixelRect& rect, const IdealPixels& ideal_pixels) {
  return ArcPlanner(lf_camera, render_camera, rect, ideal_pixels).Run();
}

}  // namespace lf
