// SPDX-License-Identifier: Apache-2.0
// The region in which LF cameras may have rays for a frame: the widened viewing frustum of thesis
// 4.2.1 ("Extraction of Relevant Images", Fig. 4.4).
#pragma once

#include <cmath>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// An axis-parallel box in world coordinates; empty by default.
struct WorldBox {
  Vec3 low = Vec3::Constant(INFINITY);
  Vec3 high = Vec3::Constant(-INFINITY);

  void Add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

// Every accepted ray passes through a point L of the lens and a point X of the focus plane that the
// plate sees (doc/ray.md, 2-5). The position c of an LF camera with such a ray is on the line
// through L and X. In axes of the lens (origin at its centre; right, up, forward):
//   c = (1 - z q) L + z t,  z: depth of c in front of the lens, negative behind it,
//                           t: X / (depth of X), q: 1 / (depth of X).
// If |L| <= r, q is in [q0, q1], and the right component of t is in [t0, t1], then the right
// component of c is at most
//   max(z t0, z t1) + r max(|1 - z q0|, |1 - z q1|)
// and this bound is a convex function of z. There is such a bound on each of four sides (right,
// left, above, below), and the set of points beyond it is convex. A box whose eight corners are all
// beyond one side is therefore completely outside of the region. The region does not depend on the
// directions in which LF cameras look.
class SeenRegion {
 public:
  // Enlarges lens and plate slightly, so that rounding errors exclude no LF camera for which
  // ContributingRect() is not empty.
  explicit SeenRegion(const RenderCamera& frame);

  // Returns true only if no LF camera at this position, or in this box, can have a ray for the
  // frame.
  bool Misses(const Vec3& centre_world) const;
  bool Misses(const WorldBox& box) const;

  // Returns true only if Misses() is false for every position in the box. May return false even if
  // Misses() is false for every position.
  bool HoldsAll(const WorldBox& box) const;

  // Upper bound of the angle between the optical axis of the frame and a ray that the frame takes;
  // pi if no bound is known.
  double ray_angle_rad() const { return ray_angle_rad_; }
  const Vec3& forward_world() const { return forward_; }

 private:
  // Returns the distance of a position (in lens axes) beyond the bound of a side (0 right, 1 left,
  // 2 above, 3 below); negative if it is inside.
  double Beyond(int side, const Vec3& place) const;
  Vec3 InLensAxes(const Vec3& world) const;

  Vec3 centre_, right_, up_, forward_;
  double radius_w_ = 0;
  // [side]: largest (slope_) and smallest (other_slope_) component of t = X / (depth of X) in the
  // direction of this side.
  double slope_[4] = {};
  double other_slope_[4] = {};
  double q_low_ = 0, q_high_ = 0;  // bounds of q = 1 / (depth of X)
  double ray_angle_rad_ = 0;
  bool is_empty_ = false;       // no element has a focus point
  bool is_everything_ = false;  // no bounds are known
};

}  // namespace lf
