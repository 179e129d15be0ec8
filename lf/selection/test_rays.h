// SPDX-License-Identifier: Apache-2.0
// Decides with the ray model alone which rays a frame accepts: the reference in the tests of
// selection.
#pragma once

#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/ray.h"
#include "lf/camera/render_camera.h"

namespace lf::testing {

// Returns true if the frame accepts the ray of pixel (x, y) (doc/ray.md, 1-5).
inline bool Contributes(const PinholeCamera& lf_camera, const DistortionMap& map,
                        const RenderCamera& render, int x, int y) {
  const std::optional<Vec3> position = IdealPosition(lf_camera.intrinsics, map, x + 0.5, y + 0.5);
  if (!position) return false;
  const Ray ray{lf_camera.CentreWorld(), lf_camera.cam_from_world.rotation.transpose() *
                                             (lf_camera.intrinsics.InverseMatrix() * *position)};
  const PinholeCamera& plate = render.pinhole;
  const Vec3 forward = plate.ForwardWorld(), centre = plate.CentreWorld();
  if (!(forward.dot(ray.direction) > 0)) return false;
  const auto on_lens = IntersectLine(ray, {forward, forward.dot(centre)});
  if (!Contains(render.aperture, {plate.RightWorld().dot(*on_lens - centre),
                                  plate.UpWorld().dot(*on_lens - centre)}))
    return false;
  const auto focus_point = IntersectLine(ray, render.focus_plane);
  if (!focus_point) return false;
  const auto element = Project(plate, *focus_point);
  return element && element->x() >= 0 && element->x() < plate.intrinsics.width_px &&
         element->y() >= 0 && element->y() < plate.intrinsics.height_px;
}

}  // namespace lf::testing
