// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/optics.h"

#include <cmath>

namespace lf {

Vec3 Reflected(const Vec3& direction, const Vec3& normal) {
  return direction - 2 * direction.dot(normal) * normal;
}

std::optional<Vec3> Refracted(const Vec3& direction, const Vec3& normal, double index_ratio) {
  const double cosine = -direction.dot(normal);
  const double sine2 = index_ratio * index_ratio * (1 - cosine * cosine);
  if (sine2 > 1) return std::nullopt;
  return index_ratio * direction + (index_ratio * cosine - std::sqrt(1 - sine2)) * normal;
}

double Reflectance(double cosine, double refractive_index) {
  const double n2 = refractive_index * refractive_index;
  const double inside = std::sqrt(n2 - 1 + cosine * cosine);  // n cos(angle of refraction)
  const double s = (cosine - inside) / (cosine + inside);
  const double p = (n2 * cosine - inside) / (n2 * cosine + inside);
  return 0.5 * (s * s + p * p);
}

}  // namespace lf
