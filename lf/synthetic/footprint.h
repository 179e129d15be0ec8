// How wide a ray is: the part of the scene that one pixel averages over.
#pragma once

#include <cmath>

namespace lf {

// Round and Gaussian, exp(-(distance / width)^2), with its centre on the ray. Along the ray the
// width is |width_w + lambda spread|: curved mirrors spread it, glass spheres draw it together (the
// paraxial optics of the widths, enough to decide over how much to average). {} is the exact ray.
struct Footprint {
  double width_w = 0;
  double spread = 0;

  double At(double lambda) const { return std::abs(width_w + lambda * spread); }
  // The same beam with its start moved along the ray.
  Footprint From(double lambda) const {
    const double width_there_w = width_w + lambda * spread;
    return width_there_w < 0 ? Footprint{-width_there_w, -spread}
                             : Footprint{width_there_w, spread};
  }
};

// The footprint whose variance is that of a square pixel `pixel_angle` wide (focal length 1):
// exp(-(d/w)^2) has variance w^2 / 2 per axis, the square 1 / 12.
inline constexpr double kFootprintPerSide = 0.40824829046386302;  // sqrt(2 / 12)
inline Footprint FootprintOfPixel(double pixel_angle) {
  return {0, pixel_angle * kFootprintPerSide};
}

}  // namespace lf
