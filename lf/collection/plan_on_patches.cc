#include "lf/collection/plan_on_patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "lf/camera/ray_forms.h"
#include "lf/collection/cubic_patch.h"
#include "lf/collection/ray_law.h"
#include "lf/core/check.h"

namespace lf {
namespace {

// Values this near to 0, relative to the terms they are summed from, may be rounding.
constexpr double kRounding = 1e-9;

enum class Share { kNone, kSome, kAll };  // of the rays of an arc or a patch

// The least and the largest value that a form can have on it.
struct Range {
  double low = 0;
  double high = 0;
  double rounding = 0;
};

// The control points of an arc or a patch, and how far they reach in each coordinate.
struct Hull {
  std::span<const Vec3> control;
  Vec3 reach;
  explicit Hull(std::span<const Vec3> points) : control(points), reach(points[0].cwiseAbs()) {
    for (const Vec3& point : points) reach = reach.cwiseMax(point.cwiseAbs());
  }
};

Range RangeOn(const Hull& hull, const PixelForm& form) {
  Range range;
  range.low = range.high = Value(form, hull.control[0]);
  for (const Vec3& point : hull.control.subspan(1)) {
    const double value = Value(form, point);
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  range.rounding =
      kRounding * (std::abs(form[0]) * hull.reach[0] + std::abs(form[1]) * hull.reach[1] +
                   std::abs(form[2]) * hull.reach[2]);
  return range;
}

// Where form <= 0.
Share AtMostZero(const Hull& hull, const PixelForm& form) {
  const Range range = RangeOn(hull, form);
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

// De Casteljau's construction: the control points of both sides of t.
void SplitCubic(const Vec3 (&c)[4], double t, Vec3 (&left)[4], Vec3 (&right)[4]) {
  const auto mix = [t](const Vec3& a, const Vec3& b) -> Vec3 { return a + t * (b - a); };
  const Vec3 middle = mix(c[1], c[2]);
  left[0] = c[0];
  left[1] = mix(c[0], c[1]);
  left[2] = mix(left[1], middle);
  right[3] = c[3];
  right[2] = mix(c[2], c[3]);
  right[1] = mix(middle, right[2]);
  left[3] = right[0] = mix(left[2], right[1]);
}

class PatchPlanner {
 public:
  PatchPlanner(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
               const PixelRect& rect, const IdealPixels& ideal_pixels,
               std::vector<CubicSegment>* segments)
      : law_(lf_camera, render_camera),
        render_camera_(render_camera),
        rect_(rect),
        in_lens_plane_(LiesInLensPlane(lf_camera, render_camera)),
        ideal_pixels_(ideal_pixels),
        forms_(MakeRayForms(lf_camera, render_camera)),
        cubics_(forms_.sensor_x, forms_.sensor_y, forms_.front),
        segments_(*segments) {
    for (const int side : {0, 1})
      plate_half_planes_[side] = PlateHalfPlanes(forms_, render_camera, side == 0 ? -1 : 1, 0);
    if (render_camera.aperture.blades > 0)
      lens_half_planes_ = LensHalfPlanes(forms_, render_camera, 0);
    for (const int side : {0, 1}) all_conditions_.plate[side] = BitsOf(plate_half_planes_[side]);
    all_conditions_.lens = BitsOf(lens_half_planes_);
    all_conditions_.disk = render_camera.aperture.blades == 0;
  }

  void Run() {
    for (const IdealPatch& patch : ideal_pixels_.patches()) AddPatch(patch);
  }

 private:
  // Those that are not known to hold: what holds of a hull holds of its parts.
  struct Conditions {
    bool sides[2] = {true, true};
    uint64_t plate[2];  // a bit for each half-plane
    uint64_t lens;
    bool disk;
  };

  static uint64_t BitsOf(const std::vector<PixelForm>& forms) {
    LF_CHECK(forms.size() <= 64);  // blades, and edges of the plate
    return forms.empty() ? 0 : ~uint64_t{0} >> (64 - forms.size());
  }

  void AddPatch(const IdealPatch& patch) {
    if (Intersection(patch.rect, rect_).empty()) return;
    const Hull hull(AllControls(patch));
    Conditions open = all_conditions_;
    const Share share = AcceptedShare(hull, &open);
    if (share == Share::kNone) return;
    // Decided by the whole patch, whatever part of it is asked for.
    const Range front = RangeOn(hull, forms_.front);
    elements_.reset();
    if (front.high - front.low < 1e-2 * std::sqrt(LeastSquare(front)))
      elements_.emplace(forms_.sensor_x, forms_.sensor_y, forms_.front, patch);
    if (elements_ && !elements_->IsNearMiddle()) elements_.reset();
    AddRows(patch, patch, share, open);
  }

  // The scanlines of `part` of a patch.
  void AddRows(const IdealPatch& part, const IdealPatch& patch, Share share,
               const Conditions& open) {
    const PixelRect clip = Intersection(part.rect, rect_);
    if (clip.empty() || share == Share::kNone) return;
    constexpr int kFewRows = 4;
    if (share == Share::kSome && part.rect.height() > kFewRows) {
      IdealPatch upper, lower;
      SplitRows(part, &upper, &lower);
      for (const IdealPatch* half : {&upper, &lower}) {
        Conditions still_open = open;
        const Share share_of_half = AcceptedShare(Hull(AllControls(*half)), &still_open);
        AddRows(*half, patch, share_of_half, still_open);
      }
      return;
    }
    for (int y = clip.y_begin; y < clip.y_end; ++y) {
      runs_.clear();
      IdealArc arc;
      if (share == Share::kSome || !elements_) arc = patch.Scanline(y);
      if (share == Share::kAll)
        AppendRun(clip.x_begin, clip.x_end);
      else
        FindRuns(arc, arc, clip.x_begin, clip.x_end, open);
      for (const PixelRun& run : runs_) {
        if (elements_)
          elements_->Append(y, run.begin, run.end, &segments_);
        else
          cubics_.AddOnArc(y, run.begin, run.end, arc, &segments_);
      }
    }
  }

  static std::span<const Vec3> AllControls(const IdealPatch& patch) {
    return std::span(&patch.control[0][0], 16);
  }

  static void SplitRows(const IdealPatch& patch, IdealPatch* upper, IdealPatch* lower) {
    const PixelRect& rect = patch.rect;
    const int middle = rect.y_begin + rect.height() / 2;
    const double t = static_cast<double>(middle - rect.y_begin) / rect.height();
    upper->rect = {rect.x_begin, rect.y_begin, rect.x_end, middle};
    lower->rect = {rect.x_begin, middle, rect.x_end, rect.y_end};
    for (int i = 0; i < 4; ++i) {
      Vec3 column[4], first[4], second[4];
      for (int j = 0; j < 4; ++j) column[j] = patch.control[j][i];
      SplitCubic(column, t, first, second);
      for (int j = 0; j < 4; ++j) upper->control[j][i] = first[j];
      for (int j = 0; j < 4; ++j) lower->control[j][i] = second[j];
    }
  }

  // Appends the accepted pixels of `part` of an arc, within [begin, end).
  void FindRuns(const IdealArc& part, const IdealArc& arc, int begin, int end, Conditions open) {
    if (part.x_begin >= end || part.x_end <= begin) return;
    const Share share = AcceptedShare(Hull(part.control), &open);
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
    FindRuns(left, arc, begin, end, open);
    FindRuns(right, arc, begin, end, open);
  }

  // At a border of pixels near the middle.
  static void Split(const IdealArc& arc, IdealArc* left, IdealArc* right) {
    const int middle = arc.x_begin + (arc.x_end - arc.x_begin) / 2;
    left->x_begin = arc.x_begin;
    left->x_end = right->x_begin = middle;
    right->x_end = arc.x_end;
    SplitCubic(arc.control, static_cast<double>(middle - arc.x_begin) / (arc.x_end - arc.x_begin),
               left->control, right->control);
  }

  void AppendRun(int begin, int end) {
    if (!runs_.empty() && runs_.back().end == begin)
      runs_.back().end = end;
    else
      runs_.push_back({begin, end});
  }

  // Narrows the conditions to those that not all rays of the hull fulfil.
  Share AcceptedShare(const Hull& hull, Conditions* open) const {
    for (const int side : {0, 1})
      if (open->sides[side] && !Narrow(hull, plate_half_planes_[side], &open->plate[side]))
        open->sides[side] = false;
    if (!open->sides[0] && !open->sides[1]) return Share::kNone;
    if (!Narrow(hull, lens_half_planes_, &open->lens)) return Share::kNone;
    if (open->disk) {
      const Share share = ShareInDisk(hull);
      if (share == Share::kNone) return share;
      open->disk = share == Share::kSome;
    }
    // The two sides of n.d = 0 exclude each other.
    const bool on_plate =
        (open->sides[0] && open->plate[0] == 0) || (open->sides[1] && open->plate[1] == 0);
    return on_plate && open->lens == 0 && !open->disk ? Share::kAll : Share::kSome;
  }

  // Clears the bits of the forms that are at most 0 everywhere; false if one is so nowhere.
  static bool Narrow(const Hull& hull, const std::vector<PixelForm>& forms, uint64_t* open) {
    for (uint64_t bits = *open; bits != 0; bits &= bits - 1) {
      const Share share = AtMostZero(hull, forms[static_cast<size_t>(std::countr_zero(bits))]);
      if (share == Share::kNone) return false;
      if (share == Share::kAll) *open &= ~(bits & -bits);
    }
    return true;
  }

  Share ShareInDisk(const Hull& hull) const {
    const Range right = RangeOn(hull, forms_.lens_right);
    const Range up = RangeOn(hull, forms_.lens_up);
    const Range forward = RangeOn(hull, forms_.forward);
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
  Conditions all_conditions_;
  const IdealPixels& ideal_pixels_;
  RayForms forms_;
  CubicSegments cubics_;
  std::vector<CubicSegment>& segments_;
  std::vector<PixelRun> runs_;          // of the scanline
  std::optional<CubicPatch> elements_;  // of the patch, if its perspective is weak
};

}  // namespace

void PlanScatterOnPatches(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          const PixelRect& rect, const IdealPixels& ideal_pixels,
                          std::vector<CubicSegment>* segments) {
  PatchPlanner(lf_camera, render_camera, rect, ideal_pixels, segments).Run();
}

}  // namespace lf
