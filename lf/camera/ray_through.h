// SPDX-License-Identifier: Apache-2.0
// The ray of an LF camera through a point of the world. Its direction points forward for the camera
// of a frame, as in the ray model (doc/ray.md, steps 2 and 3).
#pragma once

#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"

namespace lf {

class RayThrough {
 public:
  //   forward_world  the direction in which the render camera of the frame looks
  //   map            the map of the LF camera's distortion; given by callers that already have it,
  //                  because making it takes time
  RayThrough(const PinholeCamera& lf_camera, const Vec3& forward_world)
      : RayThrough(lf_camera, forward_world, DistortionMap(lf_camera.intrinsics.distortion)) {}
  RayThrough(const PinholeCamera& lf_camera, const Vec3& forward_world, const DistortionMap& map)
      : intrinsics_(lf_camera.intrinsics),
        rotation_(lf_camera.cam_from_world.rotation),
        centre_(lf_camera.CentreWorld()),
        forward_(forward_world),
        map_(map) {}

  const Vec3& centre_world() const { return centre_; }

  // Returns the direction of the line through the LF camera's centre and the point. Its sign is
  // chosen so that its scalar product with forward_world is not negative. Its length is the
  // distance between centre and point.
  Vec3 DirectionWorld(const Vec3& point_world) const {
    const Vec3 d = point_world - centre_;
    return forward_.dot(d) < 0 ? Vec3(-d) : d;
  }

  // Returns the position, in pixels, at which the LF camera records a ray with this direction. The
  // position may lie outside the image. None if the lens has no image of the direction.
  std::optional<Vec2> RecordedAt(const Vec3& direction_world) const {
    const std::optional<Vec2> distorted = map_.Distort(rotation_ * direction_world);
    if (!distorted) return std::nullopt;
    const Intrinsics& k = intrinsics_;
    return Vec2(k.fx_px * distorted->x() + k.skew_px * distorted->y() + k.cx_px,
                k.fy_px * distorted->y() + k.cy_px);
  }

  const Intrinsics& intrinsics() const { return intrinsics_; }
  const DistortionMap& map() const { return map_; }

 private:
  Intrinsics intrinsics_;
  Mat3 rotation_;
  Vec3 centre_;
  Vec3 forward_;
  DistortionMap map_;
};

}  // namespace lf
