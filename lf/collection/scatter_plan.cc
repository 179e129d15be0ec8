// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lf/camera/ray_forms.h"
#include "lf/collection/plan_on_patches.h"
#include "lf/collection/ray_model.h"
#include "lf/collection/row_spans.h"
#include "lf/collection/scatter.h"
#include "lf/core/check.h"

namespace lf {
namespace {

// Share of the radius by which candidate spans reach beyond the edges of polygonal lenses; the ray
// model then decides at the ends of these spans.
constexpr double kLensMargin = 1e-7;

// Returns the part of `rect` that can see the window of a camera on its focus plane, or all of
// `rect` if there is no window or the LF camera stands among the corners of that region.
PixelRect PixelsOfWindow(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                         const PixelRect& rect) {
  if (!render_camera.window) return rect;
  const PixelRect& window = *render_camera.window;
  const Mat3 pixel = lf_camera.intrinsics.Matrix() * lf_camera.cam_from_world.rotation;
  const Vec3 centre = lf_camera.CentreWorld();
  Vec2 low = Vec2::Constant(INFINITY), high = -low;
  int in_front = 0;
  for (const int y : {window.y_begin, window.y_end})
    for (const int x : {window.x_begin, window.x_end}) {
      const std::optional<Vec3> corner = FocusPointOfElement(render_camera, x, y);
      if (!corner) return rect;
      const Vec3 p = pixel * (*corner - centre);
      if (!(std::abs(p.z()) > 1e-6 * (*corner - centre).norm())) return rect;
      in_front += p.z() > 0 ? 1 : 0;
      const Vec2 at(p.x() / p.z(), p.y() / p.z());
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
  // A projective map takes the region to a quadrilateral, unless a line of it is mapped to
  // infinity.
  if (in_front != 0 && in_front != 4) return rect;
  constexpr double kMargin_px = 2;
  const auto rounded = [](double v) { return static_cast<int>(std::clamp(v, -1e8, 1e8)); };
  const PixelRect seen = {
      rounded(std::floor(low.x() - kMargin_px)), rounded(std::floor(low.y() - kMargin_px)),
      rounded(std::ceil(high.x() + kMargin_px)), rounded(std::ceil(high.y() + kMargin_px))};
  return Intersection(rect, seen);
}

void PlanOnLines(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                 const PixelRect& rect, std::vector<Segment>* segments) {
  const RayModel model(lf_camera, render_camera);
  const RayForms forms = MakeRayForms(lf_camera, render_camera);
  const bool is_disk = render_camera.aperture.IsDisk();
  RowSpans rows;
  for (const int side : {0, 1}) {
    const auto plate = PlateHalfPlanes(forms, render_camera, side == 0 ? -1 : 1, 0);
    rows.half_planes[side].assign(plate.begin(), plate.end());
    const std::vector<PixelForm> hood = HoodHalfPlanes(forms, render_camera, kLensMargin);
    rows.half_planes[side].insert(rows.half_planes[side].end(), hood.begin(), hood.end());
    if (is_disk) continue;
    const std::vector<PixelForm> lens = LensHalfPlanes(forms, render_camera, kLensMargin);
    rows.half_planes[side].insert(rows.half_planes[side].end(), lens.begin(), lens.end());
  }
  // All rays of an LF camera in the lens plane cross this plane at one point. The quadratic of the
  // disk would have a double root. Unless the point is surely inside the disk, the ray model
  // therefore decides about each span by its ends.
  if (is_disk && LiesInLensPlane(lf_camera, render_camera))
    rows.model_decides = !IsSurelyInDisk(lf_camera, render_camera);
  else if (is_disk)
    rows.disk = {forms.lens_right, forms.lens_up, forms.forward, render_camera.aperture.radius_w};

  rows.RestrictTo(rect);

  const SegmentMaker maker(forms.sensor_x, forms.sensor_y, forms.front);
  std::vector<RowSpan> spans;
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const auto accepted = [&](int side, int x) {
      const double plane = Value(forms.plane, x + 0.5, y + 0.5);
      return (side == 0 ? plane < 0 : plane > 0) && model.Collect(x, y);
    };
    rows.Find(y, rect.x_begin, rect.x_end, accepted, &spans);
    for (const auto& [begin, end] : spans) maker.Add(y, begin, end, segments);
  }
}

}  // namespace

ScatterPlan PlanScatter(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                        const PixelRect& rect, const TileGrid& grid,
                        const IdealPixels* ideal_pixels, ScatterPlan memory) {
  const Intrinsics& plate = render_camera.pinhole.intrinsics;
  LF_CHECK(grid.plate_width == plate.width_px && grid.plate_height == plate.height_px);
  ScatterPlan plan = std::move(memory);
  plan.grid = grid;
  plan.segments.clear();
  LF_CHECK(ideal_pixels != nullptr || !lf_camera.intrinsics.has_distortion());
  ForEachPiece(render_camera, [&](const RenderCamera& piece) {
    if (lf_camera.intrinsics.has_distortion())
      PlanScatterOnPatches(lf_camera, piece, rect, *ideal_pixels, &plan.segments);
    else
      PlanOnLines(lf_camera, piece, PixelsOfWindow(lf_camera, piece, rect), &plan.segments);
  });
  plan.pieces.Cut(plan.segments, grid);
  return plan;
}

}  // namespace lf
