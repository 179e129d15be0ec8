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
  if (lf_camera.intrinsics.has_distortion()) {
    LF_CHECK(ideal_pixels != nullptr);
    PlanScatterOnPatches(lf_camera, render_camera, rect, *ideal_pixels, &plan.segments);
  } else {
    PlanOnLines(lf_camera, render_camera, rect, &plan.segments);
  }
  plan.pieces.Cut(plan.segments, grid);
  return plan;
}

}  // namespace lf
