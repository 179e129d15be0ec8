// SPDX-License-Identifier: Apache-2.0
// Describes how a real lens bends rays. A model maps a direction (X, Y, Z) in camera axes to the
// *distorted* normalised position (xd, yd), at the radius rd from the optical axis. The calibration
// matrix K then converts (xd, yd) to pixels: x_px = fx xd + skew yd + cx, y_px = fy yd + cy.
// Formulas and parameter order agree with OpenCV and COLMAP.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "lf/core/geometry.h"

namespace lf {

enum class DistortionModel : uint8_t {
  kNone,  // xd = X / Z, yd = Y / Z
  // k1 k2 p1 p2 k3 k4 k5 k6; with x = X / Z, y = Y / Z, r^2 = x^2 + y^2:
  //   xd = x radial + 2 p1 x y + p2 (r^2 + 2 x^2)
  //   yd = y radial + p1 (r^2 + 2 y^2) + 2 p2 x y
  //   radial = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
  // (COLMAP: SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV)
  kRadialTangential,
  // k1 k2 k3 k4; the distorted radius rd as a function of the angle theta from the optical axis:
  //   rd = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
  // (OpenCV fisheye; COLMAP: OPENCV_FISHEYE, SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE,
  // SIMPLE_FISHEYE, FISHEYE)
  kFisheye,
  // omega, the field of view of an ideal fish-eye lens in radians; the distorted radius rd as a
  // function of the undistorted radius r = sqrt(X^2 + Y^2) / Z:
  //   rd = atan(2 r tan(omega / 2)) / omega
  // (Devernay and Faugeras 2001; COLMAP: FOV)
  kFov,
  // k; the undistorted radius r as a function of the distorted radius rd (Fitzgibbon 2001):
  //   r = rd / (1 + k rd^2)
  // (COLMAP: SIMPLE_DIVISION, DIVISION)
  kDivision,
  // alpha beta, a unified model (Khomutenko, Garcia and Martinet 2016); alpha in [0, 1], beta > 0;
  // with x = X / Z, y = Y / Z, r^2 = x^2 + y^2:
  //   (xd, yd) = (x, y) / (alpha sqrt(beta r^2 + 1) + 1 - alpha)
  // (COLMAP: EUCM)
  kUnified,
  // k1 k2 p1 p2 k3 k4 sx1 sy1; with the angle theta from the optical axis, s = theta^2 and
  // (u, v) = (X, Y) theta / sqrt(X^2 + Y^2):
  //   xd = u radial + 2 p1 u v + p2 (s + 2 u^2) + sx1 s
  //   yd = v radial + 2 p2 u v + p1 (s + 2 v^2) + sy1 s
  //   radial = 1 + k1 s + k2 s^2 + k3 s^3 + k4 s^4
  // (COLMAP: THIN_PRISM_FISHEYE)
  kThinPrism,
  // k0 k1 k2 k3 k4 k5 p0 p1 s0 s1 s2 s3; with the angle theta from the optical axis, s = theta^2
  // and (u, v) = (X, Y) theta / sqrt(X^2 + Y^2):
  //   (a, b) = (u, v) (1 + k0 s + k1 s^2 + k2 s^3 + k3 s^4 + k4 s^5 + k5 s^6), q = a^2 + b^2
  //   xd = a + p0 (q + 2 a^2) + 2 p1 a b + s0 q + s1 q^2
  //   yd = b + p1 (q + 2 b^2) + 2 p0 a b + s2 q + s3 q^2
  // (Project Aria: Fisheye624; COLMAP: RAD_TAN_THIN_PRISM_FISHEYE)
  kRadialTangentialThinPrism,
  // k1 k2 p1 p2 k3 k4; as kRadialTangential, with one more term instead of a denominator:
  //   radial = 1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8
  // (Metashape, RealityScan: Brown with four radial coefficients; nerfstudio's k4)
  kBrown,
};

// Parameters of a model, in the order that the comment of the model states. Parameters that the
// model does not have are 0.
using DistortionParameters = std::array<double, 12>;

struct Distortion {
  DistortionModel model = DistortionModel::kNone;
  DistortionParameters parameters = {};

  friend bool operator==(const Distortion&, const Distortion&) = default;
};

// Number of parameters that packages, packed stores and the hashes of ValueHasher contain: 12 for
// kRadialTangentialThinPrism, 8 for every other model. Files and hashes of the other models did not
// change when kRadialTangentialThinPrism was added.
constexpr size_t StoredParameterCount(DistortionModel model) {
  return model == DistortionModel::kRadialTangentialThinPrism ? 12 : 8;
}

// Returns true if the parameters are valid for their model: omega of kFov in (0, pi); alpha of
// kUnified in [0, 1] and beta above 0. All parameters of the other models are valid.
bool IsDistortion(const Distortion& distortion);

// Distorts and undistorts positions. The constructor computes the limits of the model once for many
// positions. This takes tens of microseconds. Each thread remembers the limits of the distortions
// that it used last, for which it takes less.
//
// A polynomial describes a lens only up to the first angle at which the polynomial stops increasing
// or its denominator becomes 0. Directions beyond this angle have no pixel, and pixels farther from
// the axis than the image of this angle have no ray.
class DistortionMap {
 public:
  // The parameters must be finite, and IsDistortion() must be true.
  explicit DistortionMap(const Distortion& distortion);

  // Returns (xd, yd) of a direction; none if the lens has no image of the direction. Only fish-eyes
  // (kFisheye, kThinPrism, kRadialTangentialThinPrism) see directions with Z <= 0.
  std::optional<Vec2> Distort(const Vec3& direction) const;

  // Returns the direction that is distorted to (xd, yd); none if no ray arrives there. If the model
  // has no closed formula, the direction is found by iteration: Distort() of the result is within
  // 1e-12 of (xd, yd). The length of the result is above 0 and varies smoothly over the image; Z =
  // 1 for kNone, kRadialTangential and kBrown.
  std::optional<Vec3> Undistort(const Vec2& distorted) const;

 private:
  Distortion distortion_;
  // Largest undistorted radius that has an image: r = tan(theta) for kRadialTangential and kBrown,
  // theta <= pi for fish-eyes. Other models do not use this member.
  double limit_;
  // Largest distorted radius rd that the radial part of the model reaches; infinity if there is no
  // limit.
  double distorted_limit_;
};

}  // namespace lf
