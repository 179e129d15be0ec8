// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/ray_forms.h"

#include "lf/camera/hood.h"
#include "lf/core/check.h"

namespace lf {

RayForms MakeRayForms(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  const Mat3 direction =
      lf_camera.cam_from_world.rotation.transpose() * lf_camera.intrinsics.InverseMatrix();
  return MakeRayForms(direction, lf_camera.CentreWorld(), render_camera);
}

RayForms MakeRayForms(const Mat3& direction, const Vec3& centre_world,
                      const RenderCamera& render_camera) {
  const Vec3& c = centre_world;
  const PinholeCamera& plate = render_camera.pinhole;
  const Vec3 offset = c - plate.CentreWorld();
  const Vec3 f = plate.ForwardWorld();
  const Vec3& n = render_camera.focus_plane.normal;
  const double h = render_camera.focus_plane.offset_w;

  // X is the point where the ray from the LF camera's centre c along d meets the focus plane n.X =
  // h, and c' is the lens centre:  (X - c') n.d = [ (c - c') n^T + (h - n.c) I ] d
  const Mat3 focus = offset * n.transpose() + (h - n.dot(c)) * Mat3::Identity();
  const Mat3 sensor = plate.intrinsics.Matrix() * plate.cam_from_world.rotation * focus * direction;
  // L is the point where the ray meets the lens plane f.(L - c') = 0:
  //   (L - c') f.d = [ (c - c') f^T - f.(c - c') I ] d
  const Mat3 lens = ToPlane(offset, f);

  RayForms forms;
  forms.forward = f.transpose() * direction;
  forms.plane = n.transpose() * direction;
  forms.sensor_x = sensor.row(0);
  forms.sensor_y = sensor.row(1);
  forms.front = sensor.row(2);
  forms.lens_right = plate.RightWorld().transpose() * lens * direction;
  forms.lens_up = plate.UpWorld().transpose() * lens * direction;
  if (render_camera.hood.exists()) {
    const Mat3 hood = ToPlane(offset - render_camera.hood.distance_w * f, f);
    forms.hood_right = plate.RightWorld().transpose() * hood * direction;
    forms.hood_up = plate.UpWorld().transpose() * hood * direction;
  }
  return forms;
}

std::array<PixelForm, kPlateHalfPlanes> PlateHalfPlanes(const RayForms& forms,
                                                        const RenderCamera& render_camera,
                                                        int plane_sign, double margin_px) {
  LF_CHECK(plane_sign == 1 || plane_sign == -1);
  const double s = plane_sign;
  const PixelRect elements = ElementsOf(render_camera);
  return {
      -s * forms.plane,
      -forms.forward,
      -s * forms.front,
      -s * (forms.sensor_x - (elements.x_begin - margin_px) * forms.front),
      s * (forms.sensor_x - (elements.x_end + margin_px) * forms.front),
      -s * (forms.sensor_y - (elements.y_begin - margin_px) * forms.front),
      s * (forms.sensor_y - (elements.y_end + margin_px) * forms.front),
  };
}

std::vector<PixelForm> LensHalfPlanes(const RayForms& forms, const RenderCamera& render_camera,
                                      double relative_margin) {
  const double margin_w = relative_margin * render_camera.aperture.radius_w;
  std::vector<PixelForm> half_planes;
  for (const ApertureEdge& edge : Edges(render_camera.aperture))
    half_planes.push_back(LensHalfPlane(forms, edge, margin_w));
  return half_planes;
}

std::vector<PixelForm> HoodHalfPlanes(const RayForms& forms, const RenderCamera& render_camera,
                                      double relative_margin) {
  const double margin_w = relative_margin * render_camera.hood.radius_w;
  std::vector<PixelForm> half_planes;
  for (const ApertureEdge& edge : Edges(render_camera.hood))
    half_planes.push_back(edge.normal.x() * forms.hood_right + edge.normal.y() * forms.hood_up -
                          (edge.distance_w + margin_w) * forms.forward);
  return half_planes;
}

}  // namespace lf
