// SPDX-License-Identifier: Apache-2.0
// Rays are lines: the radiance that an LF camera recorded for a ray holds along the whole line
// (thesis 2.1.1).
#pragma once

#include <optional>

#include "lf/core/geometry.h"

namespace lf {

struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();  // any length but 0

  Vec3 At(double lambda) const { return origin + lambda * direction; }
};

// Returns the intersection of the line through `ray` with `plane`, in front of or behind
// ray.origin; none if the ray is parallel to the plane.
std::optional<Vec3> IntersectLine(const Ray& ray, const Plane& plane);

}  // namespace lf
