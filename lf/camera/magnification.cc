// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/magnification.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lf/camera/ray_through.h"

namespace lf {

double Magnification(const PinholeCamera& lf_camera, const RenderCamera& frame) {
  // One width holds for the whole frame: that on focus_plane, even if there is a focal surface.
  RenderCamera render_camera = frame;
  render_camera.surface = nullptr;
  const Intrinsics& k = lf_camera.intrinsics;
  const Intrinsics& plate = render_camera.pinhole.intrinsics;
  const RayThrough ray(lf_camera, render_camera.pinhole.ForwardWorld());
  // Largest number of LF pixels per element: densest_held at points that the LF image shows,
  // densest at all points.
  double densest_held = 0, densest = 0;
  for (const double v : {0.1, 0.5, 0.9})
    for (const double u : {0.1, 0.5, 0.9}) {
      const double x = u * plate.width_px, y = v * plate.height_px;
      // Returns the position in the LF image of the focus point of plate position (x + dx, y + dy).
      const auto at = [&](double dx, double dy) -> std::optional<Vec2> {
        const std::optional<Vec3> point = FocusPointOfElement(render_camera, x + dx, y + dy);
        if (!point) return std::nullopt;
        return ray.RecordedAt(ray.DirectionWorld(*point));
      };
      const auto middle = at(0, 0), left = at(-0.5, 0), right = at(0.5, 0), above = at(0, -0.5),
                 below = at(0, 0.5);
      if (!middle || !left || !right || !above || !below) continue;
      const Vec2 along = *right - *left, down = *below - *above;
      const double pixels = std::abs(along.x() * down.y() - along.y() * down.x());
      densest = std::max(densest, pixels);
      const bool is_held = middle->x() >= 0 && middle->x() < k.width_px && middle->y() >= 0 &&
                           middle->y() < k.height_px;
      if (is_held) densest_held = std::max(densest_held, pixels);
    }
  const double pixels = densest_held > 0 ? densest_held : densest;
  return pixels > 0 && std::isfinite(pixels) ? 1 / std::sqrt(pixels) : 1;
}

}  // namespace lf
