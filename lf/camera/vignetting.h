// SPDX-License-Identifier: Apache-2.0
// The radial falloff of light in the images of an LF camera: its lens records less light towards
// the corners (natural and optical vignetting).
#pragma once

#include <array>

namespace lf {

// The share of light that is recorded at distance r from the principal point:
//
//   F(r) = 1 + v1 r^2 + v2 r^4 + v3 r^6       (Goldman, "Vignette and Exposure Calibration and
//                                             Compensation", PAMI 32(12), 2010; Hugin: Vb, Vc, Vd)
//
// r is relative to half of the diagonal of the whole image: r = 1 in the corners of an image whose
// principal point is its centre. v1 = v2 = v3 = 0 if there is no falloff.
struct Vignetting {
  std::array<double, 3> v = {};

  bool is_none() const { return v == std::array<double, 3>{}; }
  // Returns F at radius r, given r^2.
  double Falloff(double r_squared) const {
    return 1 + r_squared * (v[0] + r_squared * (v[1] + r_squared * v[2]));
  }
  friend bool operator==(const Vignetting&, const Vignetting&) = default;
};

// The least share of light that a falloff may leave anywhere in the image. Parameters that cause a
// larger loss (more than six stops) are considered wrong.
inline constexpr double kLeastFalloff = 1.0 / 64;

struct Intrinsics;

// Returns r^2 of image position (x, y), with r as defined at Vignetting.
double RadiusSquared(const Intrinsics& k, double x_px, double y_px);

// The least and the largest falloff F(r) of the vignetting in the whole image, exact up to
// rounding.
struct FalloffRange {
  double min = 1, max = 1;
};
FalloffRange FalloffRangeOf(const Intrinsics& k);

// Returns true if the falloff leaves at least kLeastFalloff, and at most 1 / kLeastFalloff, of the
// light everywhere in the image.
bool IsFalloff(const Intrinsics& k);

}  // namespace lf
