// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/ray.h"

namespace lf {

std::optional<Vec3> IntersectLine(const Ray& ray, const Plane& plane) {
  const double slope = plane.normal.dot(ray.direction);
  if (slope == 0) return std::nullopt;
  return ray.At((plane.offset_w - plane.normal.dot(ray.origin)) / slope);
}

}  // namespace lf
