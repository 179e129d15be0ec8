// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/frame_view.h"

namespace lf {
namespace {

// Returns the form of normal . (X - centre) - offset, where X is the middle of a cell on a plane.
CellForm FormOf(const SlabPlane& plane, double r_w, const Vec3& centre, const Vec3& normal,
                double offset = 0) {
  const double of_a = r_w * normal.dot(plane.axis_a), of_b = r_w * normal.dot(plane.axis_b);
  // Middle of the cell whose number in a key is 0, in widths of cells (kCellOffset, slab.h).
  const double first = 0.5 - kCellOffset;
  return {normal.dot(plane.origin_world - centre) + first * (of_a + of_b) - offset, of_a, of_b};
}

}  // namespace

FrameView::FrameView(const Slab& slab, const RenderCamera& frame, const FrameReach& reach)
    : lens_reach2_w2((frame.aperture.radius_w + reach.lens_w) *
                     (frame.aperture.radius_w + reach.lens_w)) {
  const PinholeCamera& camera = frame.pinhole;
  const Vec3 centre = camera.CentreWorld();
  const Mat3 plate_from_world = camera.intrinsics.Matrix() * camera.cam_from_world.rotation;
  const Plane& focus = frame.focus_plane;
  for (OfPlane* const plane : {&st, &uv}) {
    const auto form = [&](const Vec3& normal, double offset = 0) {
      return FormOf(plane == &st ? slab.st : slab.uv, plane == &st ? slab.r_st_w : slab.r_uv_w,
                    centre, normal, offset);
    };
    plane->forward = form(camera.ForwardWorld());
    plane->right = form(camera.RightWorld());
    plane->up = form(camera.UpWorld());
    plane->plate_x = form(plate_from_world.row(0).transpose());
    plane->plate_y = form(plate_from_world.row(1).transpose());
    plane->focus = form(focus.normal, focus.offset_w - focus.normal.dot(centre));
  }
  const std::array<int, 2> size_px = {camera.intrinsics.width_px, camera.intrinsics.height_px};
  for (int axis = 0; axis < 2; ++axis) {
    plate_low_px[axis] = -reach.plate_px;
    plate_high_px[axis] = size_px[axis] + reach.plate_px;
  }
}

RayView::RayView(const RenderCamera& frame, const FrameReach& reach)
    : centre_(frame.pinhole.CentreWorld()),
      right_(frame.pinhole.RightWorld()),
      up_(frame.pinhole.UpWorld()),
      forward_(frame.pinhole.ForwardWorld()),
      focus_plane_(frame.focus_plane),
      plate_from_world_(frame.pinhole.intrinsics.Matrix() * frame.pinhole.cam_from_world.rotation),
      lens_reach2_w2_((frame.aperture.radius_w + reach.lens_w) *
                      (frame.aperture.radius_w + reach.lens_w)),
      margin_px_(reach.plate_px),
      width_px_(frame.pinhole.intrinsics.width_px),
      height_px_(frame.pinhole.intrinsics.height_px) {}

std::optional<FrameRay> RayView::See(const Ray& ray) const {
  const double along = forward_.dot(ray.direction);
  if (!(along > 0)) return {};
  const Vec3 from_centre = ray.origin - centre_;
  const Vec3 on_lens = from_centre - forward_.dot(from_centre) / along * ray.direction;
  const Vec2 lens_point(right_.dot(on_lens), up_.dot(on_lens));
  if (!(lens_point.squaredNorm() <= lens_reach2_w2_)) return {};
  return At(lens_point, ray);
}

std::optional<FrameRay> RayView::At(const Vec2& lens_point, const Ray& ray) const {
  if (!(forward_.dot(ray.direction) > 0)) return {};
  const double slope = focus_plane_.normal.dot(ray.direction);
  if (slope == 0) return {};
  const double lambda = (focus_plane_.offset_w - focus_plane_.normal.dot(ray.origin)) / slope;
  const Vec3 element = plate_from_world_ * (ray.origin - centre_ + lambda * ray.direction);
  if (!(element.z() > 0)) return {};
  const double x = element.x() / element.z(), y = element.y() / element.z();
  if (!(x >= -margin_px_ && x <= width_px_ + margin_px_ && y >= -margin_px_ &&
        y <= height_px_ + margin_px_))
    return {};
  FrameRay seen;
  seen.lens_x_w = static_cast<float>(lens_point.x());
  seen.lens_y_w = static_cast<float>(lens_point.y());
  seen.x_px = static_cast<float>(x);
  seen.y_px = static_cast<float>(y);
  return seen;
}

}  // namespace lf
