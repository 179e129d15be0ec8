// Where LF cameras stand whose rays a frame may take: the widened viewing frustum of thesis 4.2.1
// ("Extraction of Relevant Images", Fig. 4.4).
#pragma once

#include <cmath>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// An axis-parallel box of the world.
struct WorldBox {
  Vec3 low = Vec3::Constant(INFINITY);
  Vec3 high = Vec3::Constant(-INFINITY);

  void Add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

// Every accepted ray goes through a point L of the lens and a point X of the focus plane that the
// plate sees (doc/ray.md, 2-5): an LF camera with such rays stands on their line,
//   c = (1 - z q) L + z t,  z: its depth in front of the lens, before and behind it,
//                           t: where X lies at depth 1, q: 1 / depth of X.
// With |L| <= r, t in a box and q in [q0, q1], each coordinate of c is at most
//   max(z t0, z t1) + r max(|1 - z q0|, |1 - z q1|)
// and this bound is a convex function of z. Outside it, on each of four sides, is convex: a box
// whose eight corners are all outside is wholly so. Nothing depends on where the LF cameras look.
class SeenRegion {
 public:
  // Lens and plate are grown a little, so that rounding excludes no camera that overlap.h does not.
  explicit SeenRegion(const RenderCamera& frame);

  // No camera at this place, or in the box, has a ray for the frame.
  bool Misses(const Vec3& centre_world) const;
  bool Misses(const WorldBox& box) const;

  // No camera in the box is missed.
  bool HoldsAll(const WorldBox& box) const;

  // Rays that the frame takes run within this angle of its optical axis.
  double ray_angle_rad() const { return ray_angle_rad_; }
  const Vec3& forward_world() const { return forward_; }

 private:
  // How far beyond the bounds of a side (right, left, above, below) a place in axes of the lens is.
  double Beyond(int side, const Vec3& place) const;
  Vec3 InLensAxes(const Vec3& world) const;

  Vec3 centre_, right_, up_, forward_;
  double radius_w_ = 0;
  // Of the four sides: bounds of t, of the larger and of the smaller one.
  double slope_[4] = {};
  double other_slope_[4] = {};
  double q_low_ = 0, q_high_ = 0;  // 1 / world units
  double ray_angle_rad_ = 0;
  bool is_empty_ = false;       // no element has a focus point
  bool is_everything_ = false;  // nothing can be said
};

}  // namespace lf
