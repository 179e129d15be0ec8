// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/ray_model.h"

#include <cmath>

#include "lf/camera/ideal_pixels.h"

namespace lf {

bool LiesInLensPlane(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  const Vec3 offset = lf_camera.CentreWorld() - render_camera.pinhole.CentreWorld();
  return std::abs(render_camera.pinhole.ForwardWorld().dot(offset)) <=
         1e-13 * (lf_camera.CentreWorld().norm() + render_camera.pinhole.CentreWorld().norm());
}

bool IsSurelyInDisk(const PinholeCamera& lf_camera_in_lens_plane,
                    const RenderCamera& render_camera) {
  constexpr double kMargin = 1e-4;
  const RenderCamera& r = render_camera;
  const Vec3 offset = lf_camera_in_lens_plane.CentreWorld() - r.pinhole.CentreWorld();
  return offset.norm() < (1 - kMargin) * r.aperture.radius_w;
}

RayModel::RayModel(const PinholeCamera& lf_camera, const RenderCamera& render_camera)
    : intrinsics_(lf_camera.intrinsics),
      centre_(lf_camera.CentreWorld()),
      direction_(lf_camera.cam_from_world.rotation.transpose() *
                 lf_camera.intrinsics.InverseMatrix()),
      lens_centre_(render_camera.pinhole.CentreWorld()),
      right_(render_camera.pinhole.RightWorld()),
      up_(render_camera.pinhole.UpWorld()),
      forward_(render_camera.pinhole.ForwardWorld()),
      focus_plane_(render_camera.focus_plane),
      plate_from_world_(render_camera.pinhole.intrinsics.Matrix() *
                        render_camera.pinhole.cam_from_world.rotation),
      aperture_(render_camera.aperture),
      hood_(render_camera),
      elements_(ElementsOf(render_camera)) {
  if (intrinsics_.has_distortion()) distortion_.emplace(intrinsics_.distortion);
}

std::optional<PlateElement> RayModel::Collect(int x, int y) const {
  if (!distortion_) return CollectIdeal({x + 0.5, y + 0.5, 1});
  const std::optional<Vec3> position = IdealPosition(intrinsics_, *distortion_, x + 0.5, y + 0.5);
  if (!position) return std::nullopt;
  return CollectIdeal(*position);
}

std::optional<PlateElement> RayModel::CollectIdeal(const Vec3& position) const {
  // The numbers of these steps are those of doc/ray.md, Geometry. 1. The ray.
  const Ray ray{centre_, direction_ * position};

  // 2. The ray must run forward.
  const double along = forward_.dot(ray.direction);
  if (!(along > 0)) return std::nullopt;

  // 3. The focus point, which must be in front of the lens.
  const std::optional<Vec3> focus_point = IntersectLine(ray, focus_plane_);
  if (!focus_point || !(forward_.dot(*focus_point - lens_centre_) > 0)) return std::nullopt;

  // 5. The point of the lens plane that the ray meets, as a quotient so that an LF camera in the
  //    lens plane needs no special case: M d / (f.d) with M = (c - c') f^T - (f.(c - c')) I, for
  //    the LF camera c, the ray's direction d, the lens centre c' and the forward axis f.
  const Vec3 offset = centre_ - lens_centre_;
  const Vec3 on_lens = offset - ray.direction * (forward_.dot(offset) / along);
  if (!aperture_.Contains({right_.dot(on_lens), up_.dot(on_lens)})) return std::nullopt;
  if (!hood_.LetsThrough(centre_, ray.direction)) return std::nullopt;

  // 4. The element: coordinates are rounded down, never truncated.
  const Vec3 p = plate_from_world_ * (*focus_point - lens_centre_);
  const double element_x = std::floor(p.x() / p.z());
  const double element_y = std::floor(p.y() / p.z());
  if (!(element_x >= elements_.x_begin && element_x < elements_.x_end &&
        element_y >= elements_.y_begin && element_y < elements_.y_end))
    return std::nullopt;
  return PlateElement{static_cast<int>(element_x), static_cast<int>(element_y)};
}

}  // namespace lf
