// SPDX-License-Identifier: Apache-2.0
// Camera arrangements: the positions from which the photographs of a light field are taken.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

enum class RigShape : uint8_t {
  kPlanar,  // a grid in a plane, all cameras looking along RigOptions::view_world
  kBand,  // at most 3 rows on an arc around the upright line through the target, facing the target
  kHemisphere,  // cameras spread evenly over the dome above the target, facing the target
};

struct RigOptions {
  RigShape shape = RigShape::kPlanar;
  // Wanted number of cameras. The grid has round(sqrt(count)) rows, the band min(3, count) rows.
  // Both have the number of columns for which rows times columns is nearest to count. The dome has
  // exactly `count` cameras.
  uint32_t count = 289;
  double spacing_w = 0.0025;  // distance from camera to camera; ignored for kHemisphere
  double distance_w = 1;      // distance from the middle of the rig to the target
  Vec3 target_world = Vec3::Zero();
  Vec3 view_world = Vec3::UnitZ();  // direction from the rig's middle to the target, any length
  Vec3 up_world = -Vec3::UnitY();
  // Simulates a shaky hand: every camera is moved by up to jitter * RigPitch() along each of its
  // axes and rotated by up to `jitter` degrees about each axis, uniformly distributed. The returned
  // poses include the jitter.
  double jitter = 0;
  uint64_t seed = 0;
};

// Returns cam_from_world of every camera: in rows from the upper left (grid, band), or from the
// zenith down (dome). Equal options give equal poses.
// kUsage: count is 0; a spacing or distance is not positive and finite; jitter is outside [0, 1];
// view_world is 0 or parallel to up_world; or a band is longer than its full circle.
Result<std::vector<RigidTransform>> MakeRig(const RigOptions& options);

// Returns the distance from one camera to the next in world units: RigOptions::spacing_w, or on a
// dome the mean distance.
double RigPitch(const RigOptions& options);

}  // namespace lf
