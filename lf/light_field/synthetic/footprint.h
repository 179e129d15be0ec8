// SPDX-License-Identifier: Apache-2.0
// The width of a ray (its footprint): the part of the scene over which one pixel averages.
#pragma once

#include <cmath>

namespace lf {

// The footprint is a round Gaussian, exp(-(distance from the ray / width)^2). At distance lambda
// along the ray, the width is |width_w + lambda spread|. Curved mirrors increase the spread, glass
// spheres decrease it. The widths follow paraxial optics, which is accurate enough to choose how
// much to average. Footprint{} has width 0: it is the footprint of an exact ray.
struct Footprint {
  double width_w = 0;
  double spread = 0;

  double At(double lambda) const { return std::abs(width_w + lambda * spread); }
  // Returns the footprint of the part of the ray that starts at distance lambda along the ray.
  Footprint From(double lambda) const {
    const double width_there_w = width_w + lambda * spread;
    return width_there_w < 0 ? Footprint{-width_there_w, -spread}
                             : Footprint{width_there_w, spread};
  }
};

// FootprintOfPixel() returns the footprint that has the same variance as a square pixel that is
// `pixel_angle` wide at distance 1. exp(-(d/w)^2) has the variance w^2 / 2 along each axis, a
// square of side 1 has 1 / 12.
inline constexpr double kFootprintPerSide = 0.40824829046386302;  // sqrt(2 / 12)
inline Footprint FootprintOfPixel(double pixel_angle) {
  return {0, pixel_angle * kFootprintPerSide};
}

}  // namespace lf
