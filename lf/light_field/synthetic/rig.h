// Camera arrangements: the positions from which the photographs of a light field are taken.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

enum class RigShape : uint8_t {
  kPlanar,  // a grid in a plane, all cameras looking along `view_world`
  kBand,    // up to three rows on an arc around the upright line through the target, looking at it
  kHemisphere,  // spread evenly over the dome above the target, looking at it
};

struct RigOptions {
  RigShape shape = RigShape::kPlanar;
  // Number of cameras wanted. The grid has round(sqrt(count)) rows, the band min(3, count) rows;
  // both have the number of columns that comes nearest to count. The dome has exactly this many
  // cameras.
  uint32_t count = 289;
  double spacing_w = 0.0025;  // from camera to camera; kHemisphere ignores it, because it has no
                              // pitch
  double distance_w = 1;      // from the middle of the rig to the target
  Vec3 target_world = Vec3::Zero();
  Vec3 view_world = Vec3::UnitZ();  // from the middle of the rig to the target, any length
  Vec3 up_world = -Vec3::UnitY();
  // Simulates a shaky hand: every camera is moved by up to jitter * spacing along each of its axes
  // and turned by up to jitter degrees about each, uniformly. The returned poses include the
  // jitter.
  double jitter = 0;
  uint64_t seed = 0;
};

// Returns cam_from_world of every camera, in rows from the upper left (grid, band) or from the
// zenith down (dome). Equal options give equal poses. kUsage: count is 0, a spacing or distance is
// not positive, jitter is outside [0, 1], view_world is upright, or a band is longer than its full
// circle.
Result<std::vector<RigidTransform>> MakeRig(const RigOptions& options);

// Returns the distance from one camera to the next: spacing_w, or on a dome the mean distance.
double RigPitch(const RigOptions& options);

}  // namespace lf
