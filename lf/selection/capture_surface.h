// SPDX-License-Identifier: Apache-2.0
// The positions of LF cameras as points of a plane, for the order in which LF images are taken.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

// Coordinates from 0 to kMost.
struct SurfacePoint {
  static constexpr int32_t kMost = 1 << 28;
  int32_t x = 0;
  int32_t y = 0;
};

// Returns the positions in the plane of least variance, through their mean. If a sphere fits them
// better than this plane, as on a dome around an object or in a band in a half circle, the sphere
// is unrolled instead: around the mean direction from its centre, so that equal areas stay equal
// (Lambert's azimuthal projection).
//
// If most LF cameras stand in rows and columns, these are along x and y. The longer extent is
// kMost. Only additions, multiplications, divisions and square roots are used, in a fixed order, so
// that all machines return the same points. Numbers that are not finite count as 0.
std::vector<SurfacePoint> SurfaceOf(std::span<const Vec3> positions);

// Orthogonal unit vectors.
struct PlaneAxes {
  Vec3 x = Vec3::UnitX();
  Vec3 y = Vec3::UnitY();
  Vec3 z = Vec3::UnitZ();
};

// Returns x and y in the plane of least variance of the positions, along rows and columns if most
// LF cameras stand in such, and z across this plane. The result is the same on all machines, as
// that of SurfaceOf().
PlaneAxes PlaneAxesOf(std::span<const Vec3> positions);

}  // namespace lf
