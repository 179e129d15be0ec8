// Camera arrangements: where the photographs of a light field are taken from.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

enum class RigShape : uint8_t {
  kPlanar,  // a grid in a plane, all cameras facing along `view_world`
  kBand,    // up to three rows on an arc around the upright line through the target, looking at it
  kHemisphere,  // spread evenly over the dome above the target, looking at it
};

struct RigOptions {
  RigShape shape = RigShape::kPlanar;
  // Cameras wanted. The grid takes round(sqrt(count)) rows, the band min(3, count) rows, both the
  // number of columns that comes nearest; the dome takes exactly this many.
  uint32_t count = 289;
  double spacing_w = 0.0025;  // from camera to camera; not used by kHemisphere, which has no pitch
  double distance_w = 1;      // of the middle of the rig from the target
  Vec3 target_world = Vec3::Zero();
  Vec3 view_world = Vec3::UnitZ();  // from the middle of the rig to the target, any length
  Vec3 up_world = -Vec3::UnitY();
  // A shaky hand: every camera is moved by up to jitter * spacing along each of its axes and turned
  // by up to jitter degrees about each, uniformly. The poses returned are the jittered ones.
  double jitter = 0;
  uint64_t seed = 0;
};

// cam_from_world of every camera, in rows from the upper left (grid, band) or from the zenith down
// (dome). The same for the same options.
// kUsage: count 0, a spacing or distance that is not positive, jitter outside [0, 1], view_world
// upright, a band longer than its full circle.
Result<std::vector<RigidTransform>> MakeRig(const RigOptions& options);

// Distance from one camera to the next: spacing_w, and on a dome the mean one.
double RigPitch(const RigOptions& options);

}  // namespace lf
