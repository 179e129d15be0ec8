// SPDX-License-Identifier: Apache-2.0
// The ray model of the estimator *bilinear* for one ray, applied literally, in double precision
// (doc/ray.md, "What is added"). GatherReference() applies it to every element, PlanGather() only
// to elements about which rounding or the border of the LF image might decide. Internal to
// collection.
#pragma once

#include <optional>

#include "lf/camera/hood.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/ray_through.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

class GatherModel {
 public:
  // render_camera must have the finer plate (WithFinerPlate()) if an element's ray is the mean of
  // several rays
  GatherModel(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

  // Returns the direction, in the world, of the ray through the LF camera and the focus point of
  // the centre of element (x, y); none if this focus point does not exist in front of the lens, or
  // if the ray does not pass through the lens.
  std::optional<Vec3> Direction(int x, int y) const;

  // Returns the position, in pixels, where the LF camera records the ray of element (x, y); none if
  // Direction() returns none, if one of the four pixels around the position is not in the image, or
  // if one of them recorded no ray.
  std::optional<Vec2> Position(int x, int y) const;

  // True if some pixels of the LF image have no ray, so that each position has to be tested.
  bool may_lack_rays() const { return may_lack_rays_; }

 private:
  RenderCamera render_camera_;
  Vec3 forward_, right_, up_;
  RayThrough ray_;
  Vec3 offset_;  // vector from the lens centre to the LF camera, in the world
  ApertureTest aperture_;
  HoodTest hood_;
  bool may_lack_rays_ = false;
};

// True if the four pixel centres around (x, y) are in the image.
inline bool HasFourPixels(const Intrinsics& k, double x_px, double y_px) {
  return x_px >= 0.5 && x_px < k.width_px - 0.5 && y_px >= 0.5 && y_px < k.height_px - 0.5;
}

}  // namespace lf
