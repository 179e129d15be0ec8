// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/magnification.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lf/camera/ray_through.h"

namespace lf {

MagnificationPoints::MagnificationPoints(const RenderCamera& render_camera)
    : forward_world_(render_camera.pinhole.ForwardWorld()) {
  // One width holds for the whole frame: that on focus_plane, even if there is a focal surface.
  RenderCamera on_plane = render_camera;
  on_plane.surface = nullptr;
  const Intrinsics& plate = on_plane.pinhole.intrinsics;
  size_t place = 0;
  for (const double v : {0.1, 0.5, 0.9})
    for (const double u : {0.1, 0.5, 0.9}) {
      const double x = u * plate.width_px, y = v * plate.height_px;
      const auto middle = FocusPointOfElement(on_plane, x, y),
                 left = FocusPointOfElement(on_plane, x - 0.5, y),
                 right = FocusPointOfElement(on_plane, x + 0.5, y),
                 above = FocusPointOfElement(on_plane, x, y - 0.5),
                 below = FocusPointOfElement(on_plane, x, y + 0.5);
      if (middle && left && right && above && below)
        places_[place] = Cross{*middle, *left, *right, *above, *below};
      ++place;
    }
}

double Magnification(const PinholeCamera& lf_camera, const MagnificationPoints& points) {
  const Intrinsics& k = lf_camera.intrinsics;
  const RayThrough ray(lf_camera, points.forward_world_);
  const auto recorded = [&ray](const Vec3& point) {
    return ray.RecordedAt(ray.DirectionWorld(point));
  };
  // Largest number of LF pixels per element: densest_held at points that the LF image shows,
  // densest at all points.
  double densest_held = 0, densest = 0;
  for (const auto& place : points.places_) {
    if (!place) continue;
    const auto middle = recorded(place->middle), left = recorded(place->left),
               right = recorded(place->right), above = recorded(place->above),
               below = recorded(place->below);
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
