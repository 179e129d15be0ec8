// SPDX-License-Identifier: Apache-2.0
// Reflection and refraction at mirrors and glass.
#pragma once

#include <optional>

#include "lf/core/geometry.h"

namespace lf {

// Returns the direction of a ray after its reflection, d - 2 (d.n) n, for the direction d and the
// normal n of unit length. The result has the length of d.
Vec3 Reflected(const Vec3& direction, const Vec3& normal);

// Returns the direction of a ray after its refraction at a surface, by Snell's law n1 sin = n2 sin,
// with index_ratio = n1 / n2. Both vectors have unit length, and the normal points against the
// direction. nullopt for total reflection.
std::optional<Vec3> Refracted(const Vec3& direction, const Vec3& normal, double index_ratio);

// Returns the share of unpolarised light that a glass surface reflects (Fresnel). The light enters
// glass of `refractive_index` > 1 from air at the given cosine of the angle of incidence.
double Reflectance(double cosine, double refractive_index);

}  // namespace lf
