// SPDX-License-Identifier: Apache-2.0
// Finds which elements of a row get a ray, and from which position in the LF image. If an element's
// ray is the mean of several rays, "element" means an element of the finer plate in this file.
#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/camera/ray_forms.h"
#include "lf/collection/gather.h"
#include "lf/collection/gather_model.h"
#include "lf/collection/position_patches.h"
#include "lf/collection/ray_model.h"
#include "lf/collection/row_spans.h"

namespace lf {
namespace {

// Linear forms of an element position e for one (LF camera, render camera). X is the point of the
// focus plane that the element sees, n the normal of that plane, c the centre of the LF camera; c'
// is the lens centre and f the forward axis of the render camera. The direction d of the element's
// ray is X - c or c - X, whichever runs forward.
struct GatherForms {
  PixelForm plane;       // above 0 where X is in front of the lens
  PixelForm forward;     // f.(X - c) times a positive number: > 0 if d = X - c
  PixelForm lens_right;  // lens position = (lens_right e, lens_up e) / (forward e)
  PixelForm lens_up;
  PixelForm hood_right;  // as lens_right, on the plane of the hood, if there is one
  PixelForm hood_up;
  // X - c in axes of the LF camera, times a positive number. Without lens distortion also
  // multiplied by the camera's intrinsic matrix, which yields homogeneous pixel positions.
  PixelForm across_x;
  PixelForm across_y;
  PixelForm depth;
};

GatherForms MakeForms(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  const PinholeCamera& lens = render_camera.pinhole;
  const Vec3& n = render_camera.focus_plane.normal;
  const Vec3 offset = lf_camera.CentreWorld() - lens.CentreWorld();
  const Vec3 f = lens.ForwardWorld();
  // n.(X - c'), with the letters of GatherForms, which is the same for all points X of the focus
  // plane.
  const double distance = render_camera.focus_plane.offset_w - n.dot(lens.CentreWorld());
  const double sign = distance < 0 ? -1 : 1;
  // `direction` maps an element position e to the direction d' in which the element looks, with
  // f.d' = 1. The element's focus point X is at X - c' = d' distance / n.d'.
  const Mat3 direction = lens.cam_from_world.rotation.transpose() * lens.intrinsics.InverseMatrix();
  // `to_focus` maps e to (X - c) |n.d'|, provided that n.d' has the sign of `distance`.
  const Mat3 to_focus = sign * (distance * Mat3::Identity() - offset * n.transpose()) * direction;
  const Mat3 to_lens = ToPlane(offset, f);
  GatherForms forms;
  forms.plane = sign * n.transpose() * direction;
  forms.forward = f.transpose() * to_focus;
  forms.lens_right = lens.RightWorld().transpose() * to_lens * to_focus;
  forms.lens_up = lens.UpWorld().transpose() * to_lens * to_focus;
  if (render_camera.hood.exists()) {
    const Mat3 to_hood = ToPlane(offset - render_camera.hood.distance_w * f, f);
    forms.hood_right = lens.RightWorld().transpose() * to_hood * to_focus;
    forms.hood_up = lens.UpWorld().transpose() * to_hood * to_focus;
  }
  Mat3 across = lf_camera.cam_from_world.rotation * to_focus;
  if (!lf_camera.intrinsics.has_distortion()) across = lf_camera.intrinsics.Matrix() * across;
  forms.across_x = across.row(0);
  forms.across_y = across.row(1);
  forms.depth = across.row(2);
  return forms;
}

// Returns forms that are at most 0 for every accepted element, among elements whose forward form
// has the sign `sign`. There are no forms for the borders of the LF image if it has lens
// distortion, and none for a lens that is a disk.
std::vector<PixelForm> HalfPlanes(const GatherForms& forms, const Intrinsics& k,
                                  const RenderCamera& render_camera, int sign) {
  std::vector<PixelForm> half_planes = {-forms.plane, -sign * forms.forward};
  if (!k.has_distortion()) {
    half_planes.push_back(-sign * forms.depth);
    half_planes.push_back(sign * (0.5 * forms.depth - forms.across_x));
    half_planes.push_back(sign * (forms.across_x - (k.width_px - 0.5) * forms.depth));
    half_planes.push_back(sign * (0.5 * forms.depth - forms.across_y));
    half_planes.push_back(sign * (forms.across_y - (k.height_px - 0.5) * forms.depth));
  }
  const auto add = [&](const ApertureEdge& edge, const PixelForm& right, const PixelForm& up) {
    half_planes.push_back(sign * (edge.normal.x() * right + edge.normal.y() * up -
                                  edge.distance_w * (1 + kRimTolerance) * forms.forward));
  };
  if (!render_camera.aperture.IsDisk())
    for (const ApertureEdge& edge : Edges(render_camera.aperture))
      add(edge, forms.lens_right, forms.lens_up);
  for (const ApertureEdge& edge : Edges(render_camera.hood))
    add(edge, forms.hood_right, forms.hood_up);
  return half_planes;
}

// Sorts segments by rows, and by columns within a row.
void SortByRows(int row_count, std::vector<Segment>* segments) {
  thread_local std::vector<Segment> sorted;
  thread_local std::vector<size_t> begin;
  begin.assign(static_cast<size_t>(row_count) + 1, 0);
  for (const Segment& segment : *segments) ++begin[segment.y + 1];
  for (size_t row = 1; row < begin.size(); ++row) begin[row] += begin[row - 1];
  sorted.resize(segments->size());
  std::vector<size_t>& next = begin;  // each entry advances from its row's begin to its end
  for (const Segment& segment : *segments) sorted[next[segment.y]++] = segment;
  size_t row_begin = 0;
  for (int row = 0; row < row_count; ++row) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(row_begin),
              sorted.begin() + static_cast<std::ptrdiff_t>(next[row]),
              [](const Segment& a, const Segment& b) { return a.x_begin < b.x_begin; });
    row_begin = next[row];
  }
  std::swap(sorted, *segments);
}

class GatherPlanner {
 public:
  //   finer  the render camera with the finer plate of the sampling; has no surface
  GatherPlanner(const PinholeCamera& lf_camera, const RenderCamera& finer,
                std::vector<Segment>* segments)
      : k_(lf_camera.intrinsics),
        model_(lf_camera, finer),
        forms_(MakeForms(lf_camera, finer)),
        map_(lf_camera.intrinsics.distortion),
        maker_(forms_.across_x, forms_.across_y, forms_.depth),
        patches_{PositionPatches([this](double x, double y) { return DistortedPosition(1, x, y); },
                                 ElementsOf(finer)),
                 PositionPatches([this](double x, double y) { return DistortedPosition(-1, x, y); },
                                 ElementsOf(finer))},
        segments_(*segments) {
    for (const int side : {0, 1})
      rows_.half_planes[side] = HalfPlanes(forms_, k_, finer, side == 0 ? -1 : 1);
    // All rays of an LF camera in the lens plane cross this plane at one point. Unless the point is
    // surely inside the disk, the ray model decides about each span by its ends.
    const bool is_disk = finer.aperture.IsDisk();
    if (is_disk && LiesInLensPlane(lf_camera, finer))
      rows_.model_decides = !IsSurelyInDisk(lf_camera, finer);
    else if (is_disk)
      rows_.disk = {forms_.lens_right, forms_.lens_up, forms_.forward, finer.aperture.radius_w};
    elements_ = ElementsOf(finer);
    rows_.RestrictTo(elements_);
  }

  // patches_ calls functions that refer to this object.
  GatherPlanner(const GatherPlanner&) = delete;
  GatherPlanner& operator=(const GatherPlanner&) = delete;

  // Appends the segments of the accepted elements, by rows, and by columns within a row.
  void Run() {
    for (int y = elements_.y_begin; y < elements_.y_end; ++y) {
      const auto accepted = [&](int side, int x) {
        const double forward = Value(forms_.forward, x + 0.5, y + 0.5);
        if (!(side == 0 ? forward < 0 : forward > 0)) return false;
        return k_.has_distortion() ? model_.Direction(x, y).has_value()
                                   : model_.Position(x, y).has_value();
      };
      rows_.Find(y, elements_.x_begin, elements_.x_end, accepted, &spans_);
      for (const auto& [begin, end] : spans_) {
        if (k_.has_distortion())
          AddDistorted(y, begin, end);
        else
          maker_.Add(y, begin, end, &segments_);
      }
    }
  }

 private:
  // Appends the elements of [x_begin, x_end) in row y whose rays the LF image recorded. The caller
  // has checked that these rays pass through the lens.
  void AddDistorted(int y, int x_begin, int x_end) {
    const bool is_reversed = Value(forms_.forward, x_begin + 0.5, y + 0.5) < 0;
    const size_t first = segments_.size();
    patches_[is_reversed ? 1 : 0].Add(y, x_begin, x_end, &segments_, &bounds_);
    const auto is_inside = [this](const PositionPatches::PositionBounds* bounds) {
      return bounds != nullptr && AreInside(bounds->low, bounds->high);
    };
    if (!model_.may_lack_rays() && std::all_of(bounds_.begin(), bounds_.end(), is_inside)) return;
    found_.assign(segments_.begin() + static_cast<std::ptrdiff_t>(first), segments_.end());
    segments_.resize(first);
    for (const Segment& segment : found_) {
      part_end_ = -1;
      AddParts(segment);
    }
  }

  // True if the four pixels around each position between `low` and `high` are in the image.
  bool AreInside(const Vec2& low, const Vec2& high) const {
    return HasFourPixels(k_, low.x(), low.y()) && HasFourPixels(k_, high.x(), high.y());
  }

  // Appends the elements of a segment whose rays the LF image recorded. A segment that may cross
  // the border of the image is halved until few elements are left; the ray model then decides about
  // each of them.
  void AddParts(const Segment& segment) {
    const PositionRange x = RangeOf(segment.x_poly, segment.t_begin, segment.count);
    const PositionRange y = RangeOf(segment.y_poly, segment.t_begin, segment.count);
    const Vec2 base(segment.base_x, segment.base_y);
    const Vec2 low = base + Vec2(x.low, y.low), high = base + Vec2(x.high, y.high);
    if (high.x() < 0 || high.y() < 0 || low.x() > k_.width_px || low.y() > k_.height_px) return;
    if (!model_.may_lack_rays() && AreInside(low, high)) {
      AppendPart(segment);
      return;
    }
    constexpr int kFew = 4;
    if (segment.count <= kFew) {
      for (int i = 0; i < segment.count; ++i)
        if (model_.Position(segment.x_begin + i, segment.y)) AppendPart(Part(segment, i, i + 1));
      return;
    }
    AddParts(Part(segment, 0, segment.count / 2));
    AddParts(Part(segment, segment.count / 2, segment.count));
  }

  // Returns the position in the LF image of the ray of the plate's point (x, y).
  //   sign  -1 if the ray runs from the LF camera away from the focus point, otherwise 1
  std::optional<Vec2> DistortedPosition(double sign, double x, double y) const {
    const Vec3 e(x, y, 1);
    const std::optional<Vec2> recorded = map_.Distort(
        sign * Vec3(Value(forms_.across_x, e), Value(forms_.across_y, e), Value(forms_.depth, e)));
    if (!recorded) return std::nullopt;
    return Vec2(k_.fx_px * recorded->x() + k_.skew_px * recorded->y() + k_.cx_px,
                k_.fy_px * recorded->y() + k_.cy_px);
  }

  static Segment Part(const Segment& segment, int begin, int end) {
    Segment part = segment;
    part.x_begin += begin;
    part.t_begin += static_cast<float>(begin);
    part.count = end - begin;
    return part;
  }

  // Appends a part of a segment. Joins it to the previous part of the same segment if they are
  // adjacent, because they share the polynomials.
  void AppendPart(const Segment& part) {
    if (part.x_begin == part_end_)
      segments_.back().count += part.count;
    else
      segments_.push_back(part);
    part_end_ = part.x_begin + part.count;
  }

  Intrinsics k_;
  GatherModel model_;
  GatherForms forms_;
  DistortionMap map_;
  SegmentMaker maker_;
  PositionPatches patches_[2];  // [1]: of rays that run away from the focus point
  RowSpans rows_;
  std::vector<Segment>& segments_;
  PixelRect elements_;          // elements of the finer plate that take rays
  std::vector<RowSpan> spans_;  // spans of the current row
  std::vector<Segment> found_;  // segments of the current span
  std::vector<const PositionPatches::PositionBounds*>
      bounds_;         // of the segments that patches_ added last
  int part_end_ = -1;  // x_end of the part appended last; -1 at a new segment
};

}  // namespace

GatherPlan PlanGather(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                      GatherPlan memory, const PixelReading& reading) {
  GatherPlan plan = std::move(memory);
  plan.sampling = SamplingOf(lf_camera, render_camera, reading);
  plan.plate_width = render_camera.pinhole.intrinsics.width_px;
  plan.plate_height = render_camera.pinhole.intrinsics.height_px;
  plan.segments.clear();
  ForEachPiece(render_camera, [&](const RenderCamera& piece) {
    GatherPlanner(lf_camera, WithFinerPlate(piece, plan.sampling.samples), &plan.segments).Run();
  });
  if (render_camera.surface) SortByRows(plan.plate_height * plan.sampling.samples, &plan.segments);
  plan.row_begin.assign(static_cast<size_t>(plan.plate_height) * plan.sampling.samples + 1, 0);
  for (const Segment& segment : plan.segments) ++plan.row_begin[segment.y + 1];
  for (size_t row = 1; row < plan.row_begin.size(); ++row)
    plan.row_begin[row] += plan.row_begin[row - 1];
  return plan;
}

}  // namespace lf
