#include "lf/collection/scatter_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/camera/ray_forms.h"
#include "lf/collection/plan_on_patches.h"
#include "lf/collection/ray_law.h"
#include "lf/collection/row_spans.h"
#include "lf/core/check.h"

namespace lf {
namespace {

ScatterPlan PlanOnLines(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                        const PixelRect& rect) {
  const RayLaw law(lf_camera, render_camera);
  const RayForms forms = MakeRayForms(lf_camera, render_camera);
  const bool is_disk = render_camera.aperture.blades == 0;
  RowSpans rows;
  for (const int side : {0, 1}) {
    rows.half_planes[side] = PlateHalfPlanes(forms, render_camera, side == 0 ? -1 : 1, 0);
    if (is_disk) continue;
    const std::vector<PixelForm> lens = LensHalfPlanes(forms, render_camera, kLensMargin);
    rows.half_planes[side].insert(rows.half_planes[side].end(), lens.begin(), lens.end());
  }
  // All rays of a camera in the lens plane cross it at one point: the law at the ends of a span
  // decides for them all, where the quadratic would have a double root.
  if (is_disk && !LiesInLensPlane(lf_camera, render_camera))
    rows.disk = {forms.lens_right, forms.lens_up, forms.forward, render_camera.aperture.radius_w};

  const CubicSegments cubics(forms.sensor_x, forms.sensor_y, forms.front);
  std::vector<CubicSegment>& segments = ScratchSegments();
  std::vector<RowSpan> spans;
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const auto accepted = [&](int side, int x) {
      const double plane = Value(forms.plane, x + 0.5, y + 0.5);
      return (side == 0 ? plane < 0 : plane > 0) && law.Collect(x, y);
    };
    rows.Find(y, rect.x_begin, rect.x_end, accepted, &spans);
    for (const auto& [begin, end] : spans) cubics.Add(y, begin, end, &segments);
  }
  const Intrinsics& plate = render_camera.pinhole.intrinsics;
  return MakeScatterPlan(segments, plate.width_px, plate.height_px);
}

}  // namespace

std::vector<CubicSegment>& ScratchSegments() {
  thread_local std::vector<CubicSegment> segments;
  segments.clear();
  return segments;
}

ScatterPlan MakeScatterPlan(const std::vector<CubicSegment>& segments, int plate_width,
                            int plate_height) {
  ScatterPlan plan;
  plan.plate_width = plate_width;
  plan.plate_height = plate_height;
  plan.segments.reserve(segments.size());
  // As the kernel clamps.
  const auto element = [](double position, int last) {
    return static_cast<int>(std::clamp<double>(std::floor(position), 0, last));
  };
  for (const CubicSegment& cubic : segments) {
    RaySegment segment{cubic, {}, 0};
    const SegmentBounds bounds = BoundsOf(cubic);
    segment.elements = {
        element(bounds.x_low, plate_width - 1), element(bounds.y_low, plate_height - 1),
        element(bounds.x_high, plate_width - 1) + 1, element(bounds.y_high, plate_height - 1) + 1};
    const double crowd = bounds.least_step > 1e-6 ? 2 + 1.01 / bounds.least_step : cubic.count;
    segment.crowd = static_cast<uint32_t>(std::min<double>(cubic.count, crowd));
    if (plan.segments.size() % ScatterPlan::kBlock == 0) plan.block_elements.emplace_back();
    plan.block_elements.back() = Bounds(plan.block_elements.back(), segment.elements);
    plan.segments.push_back(segment);
  }
  return plan;
}

ScatterPlan PlanScatter(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                        const PixelRect& rect, const IdealPixels* ideal_pixels) {
  if (!lf_camera.intrinsics.has_distortion()) return PlanOnLines(lf_camera, render_camera, rect);
  LF_CHECK(ideal_pixels != nullptr);
  return PlanScatterOnPatches(lf_camera, render_camera, rect, *ideal_pixels);
}

}  // namespace lf
