// SPDX-License-Identifier: Apache-2.0
// The pinhole camera (thesis 2.2.2-2.2.4). An LF camera is a pinhole camera, whose lens may have
// distortion. The rays through the lens centre of a render camera are those of a pinhole camera
// without distortion.
#pragma once

#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/ray.h"
#include "lf/camera/vignetting.h"
#include "lf/core/geometry.h"

namespace lf {

// The calibration matrix K (thesis Eq. 2.5) and the size of the image, in pixels. Continuous pixel
// coordinates: the centre of the upper left pixel is (0.5, 0.5).
struct Intrinsics {
  double fx_px = 1;
  double fy_px = 1;
  double cx_px = 0;
  double cy_px = 0;
  double skew_px = 0;
  int width_px = 0;
  int height_px = 0;
  Distortion distortion = {};  // lens distortion of ray directions, applied before K
  Vignetting vignetting = {};  // falloff of light, by which recorded radiance is divided

  bool has_distortion() const { return distortion.model != DistortionModel::kNone; }
  Mat3 Matrix() const;
  Mat3 InverseMatrix() const;  // K^-1, by a closed formula; fx_px and fy_px must not be 0
  friend bool operator==(const Intrinsics&, const Intrinsics&) = default;
};

struct PinholeCamera {
  Intrinsics intrinsics;
  RigidTransform cam_from_world;

  // Returns the camera centre c = -R^T t.
  Vec3 CentreWorld() const { return cam_from_world.Inverse().translation; }
  Vec3 RightWorld() const { return cam_from_world.rotation.row(0).transpose(); }
  Vec3 UpWorld() const { return -cam_from_world.rotation.row(1).transpose(); }
  Vec3 ForwardWorld() const { return cam_from_world.rotation.row(2).transpose(); }
};

// Returns the pose of the camera at `centre` that looks along `forward` and is rolled so that `up`
// points upwards in its image. None if forward or up is 0, or if they are parallel.
std::optional<RigidTransform> LookAlong(const Vec3& centre_world, const Vec3& forward_world,
                                        const Vec3& up_world);

// Returns the ray through continuous pixel position (x, y) of a camera without distortion. Its
// direction in camera axes is K^-1 (x, y, 1)^T (thesis Eq. 4.1, 4.2), whose component along the
// optical axis is 1; therefore Ray::At(z) is the point at depth z.
Ray RayOfPixel(const PinholeCamera& camera, double x_px, double y_px);

// Returns the position, in pixels, of a point in the image of a camera without distortion, by P = K
// [R|t] (thesis Eq. 2.6, 2.7). None if the point is at depth 0 or behind the camera.
std::optional<Vec2> Project(const PinholeCamera& camera, const Vec3& point_world);

}  // namespace lf
