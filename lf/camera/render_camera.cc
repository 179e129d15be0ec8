// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/render_camera.h"

#include <cmath>

namespace lf {

Plane FocusPlane(const PinholeCamera& camera, double focus_distance_w, const FocusTilt& tilt) {
  // In camera coordinates (x right, y down, z forward), a plane that is tilted by the angles h
  // (horizontal) and v (vertical) has the points with z = g + x tan(h) - y tan(v). This is
  // (-tan h, tan v, 1) . X_camera = g.
  const Vec3 normal_camera(-std::tan(tilt.horizontal_rad), std::tan(tilt.vertical_rad), 1);
  const Vec3 normal_world = camera.cam_from_world.rotation.transpose() * normal_camera.normalized();
  const Vec3 on_axis = camera.CentreWorld() + focus_distance_w * camera.ForwardWorld();
  return {normal_world, normal_world.dot(on_axis)};
}

Vec2 ShiftOf(const RenderCamera& camera) {
  const Intrinsics& plate = camera.pinhole.intrinsics;
  const double w_per_px = camera.sensor_width_w / plate.width_px;
  return {(0.5 * plate.width_px - plate.cx_px) * w_per_px,
          (plate.cy_px - 0.5 * plate.height_px) * w_per_px};
}

void OpenUpTo(double radius_w, RenderCamera* camera) {
  camera->aperture = {radius_w, 0, 0};
  camera->hood = {};
  camera->transmission = nullptr;
}

bool HasShape(const RenderCamera& camera) {
  return camera.aperture.ratio != 1 || camera.aperture.roundness != 0 || camera.hood.exists();
}

bool IsShape(const RenderCamera& camera) {
  const Aperture& aperture = camera.aperture;
  const Hood& hood = camera.hood;
  return aperture.ratio >= 1 / kMostRatio && aperture.ratio <= kMostRatio &&
         aperture.roundness >= 0 && aperture.roundness <= 1 && hood.distance_w >= 0 &&
         hood.radius_w >= 0 && (!hood.exists() || aperture.blades <= kMostBladesInHood);
}

Vec3 LensPointWorld(const RenderCamera& camera, const Vec2& point_lens) {
  return camera.pinhole.CentreWorld() + point_lens.x() * camera.pinhole.RightWorld() +
         point_lens.y() * camera.pinhole.UpWorld();
}

PixelRect ElementsOf(const RenderCamera& camera) {
  const Intrinsics& plate = camera.pinhole.intrinsics;
  return camera.window.value_or(PixelRect{0, 0, plate.width_px, plate.height_px});
}

RenderCamera FocusedAsAt(const RenderCamera& camera, double x_px, double y_px) {
  RenderCamera focused = camera;
  if (!camera.surface) return focused;
  focused.focus_plane = PlaneOfPiece(camera.pinhole, camera.surface->PieceAt(x_px, y_px));
  focused.surface = nullptr;
  return focused;
}

std::optional<Vec3> FocusPointOfElement(const RenderCamera& camera, double x_px, double y_px) {
  const Ray ray = RayOfPixel(camera.pinhole, x_px, y_px);
  if (camera.surface) return ray.At(1 / camera.surface->PieceAt(x_px, y_px).At(x_px, y_px));
  const std::optional<Vec3> point = IntersectLine(ray, camera.focus_plane);
  if (!point) return std::nullopt;
  const double depth = camera.pinhole.ForwardWorld().dot(*point - ray.origin);
  if (!(depth > 0)) return std::nullopt;
  return point;
}

}  // namespace lf
