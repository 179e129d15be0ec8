// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/plan_on_patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "lf/camera/ray_forms.h"
#include "lf/collection/element_patch.h"
#include "lf/collection/patch_edges.h"
#include "lf/collection/patch_hull.h"
#include "lf/collection/ray_model.h"
#include "lf/core/check.h"

namespace lf {
namespace {

enum class RayShare { kNone, kSome, kAll };  // accepted share of the rays of an arc or a patch

// Returns the share of the hull where form <= 0.
RayShare AtMostZero(const Hull& hull, const PixelForm& form) {
  const Range range = RangeOn(hull, form);
  if (range.low > range.rounding) return RayShare::kNone;
  return range.high < -range.rounding ? RayShare::kAll : RayShare::kSome;
}

// Splits the curve with the control points c at the parameter t, and writes the control points of
// both parts (De Casteljau's construction).
void SplitBezier(const Vec3 (&c)[IdealPatch::kControls], double t,
                 Vec3 (&left)[IdealPatch::kControls], Vec3 (&right)[IdealPatch::kControls]) {
  std::copy(std::begin(c), std::end(c), std::begin(right));
  for (int k = 0; k < IdealPatch::kControls; ++k) {
    left[k] = right[0];
    for (int i = 0; i < IdealPatch::kControls - 1 - k; ++i)
      right[i] += t * (right[i + 1] - right[i]);
  }
}

class PatchPlanner {
 public:
  PatchPlanner(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
               const PixelRect& rect, const IdealPixels& ideal_pixels,
               std::vector<Segment>* segments)
      : model_(lf_camera, render_camera),
        render_camera_(render_camera),
        rect_(rect),
        in_lens_plane_(LiesInLensPlane(lf_camera, render_camera)),
        ideal_pixels_(ideal_pixels),
        forms_(MakeRayForms(lf_camera, render_camera)),
        maker_(forms_.sensor_x, forms_.sensor_y, forms_.front),
        segments_(*segments) {
    for (const int side : {0, 1}) {
      const auto plate = PlateHalfPlanes(forms_, render_camera, side == 0 ? -1 : 1, 0);
      plate_half_planes_[side].assign(plate.begin(), plate.end());
    }
    if (!render_camera.aperture.IsDisk())
      lens_half_planes_ = LensHalfPlanes(forms_, render_camera, 0);
    const std::vector<PixelForm> hood = HoodHalfPlanes(forms_, render_camera, 0);
    lens_half_planes_.insert(lens_half_planes_.end(), hood.begin(), hood.end());
    for (const int side : {0, 1}) all_conditions_.plate[side] = BitsOf(plate_half_planes_[side]);
    all_conditions_.lens = BitsOf(lens_half_planes_);
    all_conditions_.disk = render_camera.aperture.IsDisk();
  }

  void Run() {
    for (const IdealPatch& patch : ideal_pixels_.patches()) AddPatch(patch);
  }

 private:
  // Accepted pixels [begin, end) of a scanline.
  struct PixelRun {
    int begin;
    int end;
  };

  // The open conditions: those that are not known to hold on a whole hull. A condition that holds
  // on a hull holds on all its parts.
  struct Conditions {
    // [0]: rays with n.d < 0, [1]: with n.d > 0 (n: normal of the focus plane, d: direction of the
    // ray); false: the side accepts no ray.
    bool sides[2] = {true, true};
    uint64_t plate[2];  // for each side, a bit for each half-plane
    uint64_t lens;      // a bit for each edge of a polygonal lens
    bool disk;
  };

  static uint64_t BitsOf(const std::vector<PixelForm>& forms) {
    LF_CHECK(forms.size() <= 64);  // a form for each edge of lens and hood, or kPlateHalfPlanes
    return forms.empty() ? 0 : ~uint64_t{0} >> (64 - forms.size());
  }

  void AddPatch(const IdealPatch& patch) {
    if (Intersection(patch.rect, rect_).empty()) return;
    const Hull hull(patch);
    Conditions open = all_conditions_;
    const RayShare share = AcceptedShare(hull, &open);
    if (share == RayShare::kNone) return;
    // Polynomials are fitted to the whole patch, so that positions do not depend on rect_.
    columns_.clear();
    FitColumns(patch, patch.rect.x_begin, patch.rect.x_end);
    AddRows(patch, patch, share, open);
  }

  void FitColumns(const IdealPatch& patch, int x_begin, int x_end) {
    constexpr int kNarrow = 32;
    std::optional<ElementPatch> elements =
        ElementPatch::Fit(forms_.sensor_x, forms_.sensor_y, forms_.front, patch, x_begin, x_end);
    if (!elements && x_end - x_begin > kNarrow) {
      const int middle = x_begin + (x_end - x_begin) / 2;
      FitColumns(patch, x_begin, middle);
      FitColumns(patch, middle, x_end);
      return;
    }
    columns_.push_back({x_begin, x_end, elements});
  }

  // Appends the segments of the scanlines of `part`, which is `patch` or some rows of it, with the
  // accepted share `share` and the open conditions `open`.
  void AddRows(const IdealPatch& part, const IdealPatch& patch, RayShare share,
               const Conditions& open) {
    const PixelRect clip = Intersection(part.rect, rect_);
    if (clip.empty() || share == RayShare::kNone) return;
    const bool by_edges = share == RayShare::kSome && SetEdges(part, open);
    constexpr int kFewRows = 4;
    if (share == RayShare::kSome && !by_edges && part.rect.height() > kFewRows) {
      IdealPatch upper, lower;
      SplitRows(part, &upper, &lower);
      for (const IdealPatch* half : {&upper, &lower}) {
        Conditions still_open = open;
        const RayShare share_of_half = AcceptedShare(Hull(*half), &still_open);
        AddRows(*half, patch, share_of_half, still_open);
      }
      return;
    }
    for (int y = clip.y_begin; y < clip.y_end; ++y) {
      runs_.clear();
      if (share == RayShare::kAll) {
        AppendRun(clip.x_begin, clip.x_end);
      } else if (!by_edges || !FindRunBetweenEdges(patch, y, clip)) {
        const IdealArc arc = patch.Scanline(y);
        FindRuns(arc, arc, clip.x_begin, clip.x_end, open);
      }
      for (const PixelRun& run : runs_) AppendSegments(patch, y, run);
    }
  }

  void AppendSegments(const IdealPatch& patch, int y, const PixelRun& run) {
    for (const Columns& columns : columns_) {
      const int begin = std::max(run.begin, columns.x_begin);
      const int end = std::min(run.end, columns.x_end);
      if (begin >= end) continue;
      if (columns.elements)
        columns.elements->Append(y, begin, end, &segments_);
      else
        maker_.AddOnArc(y, begin, end, patch.Scanline(y), &segments_);
    }
  }

  // Sets `edges_` to the open conditions of a part of a patch. Returns false if edges cannot decide
  // them: because both sides (Conditions::sides) are open, or because the disk is open and the LF
  // camera lies in the lens plane or PatchEdges::AddDisk() refuses the disk.
  bool SetEdges(const IdealPatch& part, const Conditions& open) {
    if (open.sides[0] == open.sides[1]) return false;
    edges_.Begin(part);
    const auto add = [&](const std::vector<PixelForm>& forms, uint64_t bits) {
      for (; bits != 0; bits &= bits - 1)
        edges_.AddForm(forms[static_cast<size_t>(std::countr_zero(bits))]);
    };
    const int side = open.sides[0] ? 0 : 1;
    add(plate_half_planes_[side], open.plate[side]);
    add(lens_half_planes_, open.lens);
    return !open.disk ||
           (!in_lens_plane_ && edges_.AddDisk({forms_.lens_right, forms_.lens_up, forms_.forward,
                                               render_camera_.aperture.radius_w}));
  }

  // Appends the one run of scanline y between edges, if it is not empty. The ray model decides
  // about pixels near the edges. Returns false if PatchEdges::Find() fails.
  bool FindRunBetweenEdges(const IdealPatch& patch, int y, const PixelRect& clip) {
    const std::optional<PatchEdges::Pixels> pixels = edges_.Find(y);
    if (!pixels) return false;
    const auto is_accepted = [&](int x) {
      if (x >= pixels->sure_begin && x <= pixels->sure_end) return true;
      const IdealArc arc = patch.Scanline(y);
      return model_.CollectIdeal(arc.At(arc.Parameter(x))).has_value();
    };
    int begin = std::max(clip.x_begin, static_cast<int>(std::ceil(pixels->begin)));
    int end = std::min(clip.x_end, static_cast<int>(std::floor(pixels->end)) + 1);
    while (begin < end && !is_accepted(begin)) ++begin;
    while (begin < end && !is_accepted(end - 1)) --end;
    if (begin < end) AppendRun(begin, end);
    return true;
  }

  static void SplitRows(const IdealPatch& patch, IdealPatch* upper, IdealPatch* lower) {
    const PixelRect& rect = patch.rect;
    const int middle = rect.y_begin + rect.height() / 2;
    const double t = static_cast<double>(middle - rect.y_begin) / rect.height();
    upper->rect = {rect.x_begin, rect.y_begin, rect.x_end, middle};
    lower->rect = {rect.x_begin, middle, rect.x_end, rect.y_end};
    for (int i = 0; i < IdealPatch::kControls; ++i) {
      Vec3 column[IdealPatch::kControls], first[IdealPatch::kControls],
          second[IdealPatch::kControls];
      for (int j = 0; j < IdealPatch::kControls; ++j) column[j] = patch.control[j][i];
      SplitBezier(column, t, first, second);
      for (int j = 0; j < IdealPatch::kControls; ++j) upper->control[j][i] = first[j];
      for (int j = 0; j < IdealPatch::kControls; ++j) lower->control[j][i] = second[j];
    }
  }

  // Appends the runs of accepted pixels of `part`, a part of `arc`, within [begin, end).
  void FindRuns(const IdealArc& part, const IdealArc& arc, int begin, int end, Conditions open) {
    if (part.x_begin >= end || part.x_end <= begin) return;
    const RayShare share = AcceptedShare(Hull(part), &open);
    if (share == RayShare::kNone) return;
    if (share == RayShare::kAll) {
      AppendRun(std::max(begin, part.x_begin), std::min(end, part.x_end));
      return;
    }
    constexpr int kFewPixels = 4;
    if (part.x_end - part.x_begin <= kFewPixels) {
      for (int x = std::max(begin, part.x_begin); x < std::min(end, part.x_end); ++x)
        if (model_.CollectIdeal(arc.At(arc.Parameter(x)))) AppendRun(x, x + 1);
      return;
    }
    IdealArc left, right;
    Split(part, &left, &right);
    FindRuns(left, arc, begin, end, open);
    FindRuns(right, arc, begin, end, open);
  }

  // Splits an arc at the border between two pixels near its middle.
  static void Split(const IdealArc& arc, IdealArc* left, IdealArc* right) {
    const int middle = arc.x_begin + (arc.x_end - arc.x_begin) / 2;
    left->x_begin = arc.x_begin;
    left->x_end = right->x_begin = middle;
    right->x_end = arc.x_end;
    SplitBezier(arc.control, static_cast<double>(middle - arc.x_begin) / (arc.x_end - arc.x_begin),
                left->control, right->control);
  }

  void AppendRun(int begin, int end) {
    if (!runs_.empty() && runs_.back().end == begin)
      runs_.back().end = end;
    else
      runs_.push_back({begin, end});
  }

  // Returns the accepted share of the hull. Removes from `open` the conditions that all rays of the
  // hull are known to fulfil.
  RayShare AcceptedShare(const Hull& hull, Conditions* open) const {
    for (const int side : {0, 1})
      if (open->sides[side] && !Narrow(hull, plate_half_planes_[side], &open->plate[side]))
        open->sides[side] = false;
    if (!open->sides[0] && !open->sides[1]) return RayShare::kNone;
    if (!Narrow(hull, lens_half_planes_, &open->lens)) return RayShare::kNone;
    if (open->disk) {
      const RayShare share = ShareInDisk(hull);
      if (share == RayShare::kNone) return share;
      open->disk = share == RayShare::kSome;
    }
    // The two sides exclude each other: all rays are on one side if it has no open condition.
    const bool on_plate =
        (open->sides[0] && open->plate[0] == 0) || (open->sides[1] && open->plate[1] == 0);
    return on_plate && open->lens == 0 && !open->disk ? RayShare::kAll : RayShare::kSome;
  }

  // Clears the bits of the forms that are at most 0 on the whole hull. Returns false if a form is
  // above 0 on the whole hull.
  static bool Narrow(const Hull& hull, const std::vector<PixelForm>& forms, uint64_t* open) {
    for (uint64_t bits = *open; bits != 0; bits &= bits - 1) {
      const RayShare share = AtMostZero(hull, forms[static_cast<size_t>(std::countr_zero(bits))]);
      if (share == RayShare::kNone) return false;
      if (share == RayShare::kAll) *open &= ~(bits & -bits);
    }
    return true;
  }

  RayShare ShareInDisk(const Hull& hull) const {
    const Range right = RangeOn(hull, forms_.lens_right);
    const Range up = RangeOn(hull, forms_.lens_up);
    const Range forward = RangeOn(hull, forms_.forward);
    if (!(forward.low > 0)) return RayShare::kSome;
    const double r2 = render_camera_.aperture.radius_w * render_camera_.aperture.radius_w;
    // If the LF camera lies in the lens plane, all rays meet that plane at one point (l_x, l_u):
    // lens_right = l_x forward, lens_up = l_u forward. The quotient is then a tighter bound.
    if (in_lens_plane_) {
      const double l2 = (right.LargestSquare() + up.LargestSquare()) /
                        std::max(forward.high * forward.high, 1e-300);
      if (l2 > r2 * (1 + kInLensPlaneMargin)) return RayShare::kNone;
      return l2 < r2 * (1 - kInLensPlaneMargin) ? RayShare::kAll : RayShare::kSome;
    }
    const double rounding = DiskRounding(right, up, forward, render_camera_.aperture.radius_w);
    if (right.LeastSquare() + up.LeastSquare() > r2 * forward.LargestSquare() + rounding)
      return RayShare::kNone;
    return right.LargestSquare() + up.LargestSquare() < r2 * forward.LeastSquare() - rounding
               ? RayShare::kAll
               : RayShare::kSome;
  }

  static constexpr double kInLensPlaneMargin = 1e-6;

  RayModel model_;
  const RenderCamera& render_camera_;
  PixelRect rect_;
  bool in_lens_plane_;
  std::vector<PixelForm> plate_half_planes_[2];
  std::vector<PixelForm> lens_half_planes_;
  Conditions all_conditions_;
  const IdealPixels& ideal_pixels_;
  RayForms forms_;
  SegmentMaker maker_;
  std::vector<Segment>& segments_;
  std::vector<PixelRun> runs_;  // runs of the current scanline
  // Columns of the current patch, in which one fit yields the polynomials of all scanlines.
  // `elements` is empty if no fit is accurate enough; each scanline is then fitted by itself.
  struct Columns {
    int x_begin, x_end;
    std::optional<ElementPatch> elements;
  };
  std::vector<Columns> columns_;
  PatchEdges edges_;  // edges of the current part of the patch
};

}  // namespace

void PlanScatterOnPatches(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          const PixelRect& rect, const IdealPixels& ideal_pixels,
                          std::vector<Segment>* segments) {
  PatchPlanner(lf_camera, render_camera, rect, ideal_pixels, segments).Run();
}

}  // namespace lf
