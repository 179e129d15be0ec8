// SPDX-License-Identifier: Apache-2.0
// Places virtual LF cameras between recorded ones, and chooses the LF images that theirs are made
// of.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/densify/camera_lattice.h"
#include "lf/densify/camera_plane.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct VirtualCamera {
  PinholeCamera camera;                // without distortion
  std::vector<WeightedPoint> sources;  // LF images with their weights
  bool is_beyond = false;              // true: it fills a lens beyond the hull of the LF cameras
};

// Adds the nearest points that are no sources yet, until there are six or no more, and makes all
// weights add up to 1.
void AddNearest(std::span<const Vec2> points, const Vec2& place,
                std::vector<WeightedPoint>* sources);

// Returns the virtual LF camera at a place of the plane. Its position, direction and intrinsics are
// the means of those of the neighbours; a place outside the hull of the LF cameras moves it along
// the plane. Its sources are the neighbours and the nearest other LF cameras, six in all, unless
// there are fewer.
VirtualCamera VirtualCameraAt(const LightField& light_field, const CameraPlane& plane,
                              const LatticePlace& at, int divisor);

}  // namespace lf
