// The thin-lens camera of one frame: what doc/ray.md calls K', R', c', the lens and the focus
// plane.
#pragma once

#include <optional>

#include "lf/camera/aperture.h"
#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"

namespace lf {

// Depth of the focus plane at (x right, u up), in camera coordinates:
//   g + x tan(horizontal) + u tan(vertical)
struct FocusTilt {
  double horizontal_rad = 0;
  double vertical_rad = 0;
};

struct RenderCamera {
  PinholeCamera pinhole;  // sensor plate elements as seen through the lens centre
  Aperture aperture;      // in the plane through the lens centre normal to the optical axis
  Plane focus_plane;      // in the world

  // The settings that the planes were made from, for people and metadata.
  double time_s = 0;
  double focal_length_w = 0;
  double sensor_width_w = 0;
  double focus_distance_w = 0;  // g, along the optical axis
  FocusTilt focus_tilt;
  double unit_m = 1;  // metres per world unit
};

// The focus plane at distance g in front of `camera`, tilted. g > 0, tilts within +-90 degrees.
Plane FocusPlane(const PinholeCamera& camera, double focus_distance_w, const FocusTilt& tilt);

// A point of the lens in the world: (right, up) in lens coordinates.
Vec3 LensPointWorld(const RenderCamera& camera, const Vec2& point_lens);

// The refraction of a thin lens: the point of the focus plane that element position (x, y) sees
// through every point of the lens (thesis 2.3.2). None where the tilted plane lies behind the lens.
std::optional<Vec3> FocusPointOfElement(const RenderCamera& camera, double x_px, double y_px);

}  // namespace lf
