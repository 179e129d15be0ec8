// Random pairs of an LF camera and a render camera for tests: LF cameras in front of, behind and in
// the lens plane, tilted focus planes whose horizon is in view, disks and polygons, rolled images.
#pragma once

#include <cstdint>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"

namespace lf::testing {

struct CameraPair {
  PinholeCamera lf_camera;
  RenderCamera render_camera;
};

// The LF image has 50 x 35 pixels, the plate 160 x 120 elements. The kind of scene depends on the
// seed modulo small numbers.
CameraPair RandomCameraPair(uint64_t seed);

// Same as RandomCameraPair(), but with an LF image of 200 x 140 pixels and lens distortion. The
// seed selects one of seven distortions: radial (a phone), radial with tangential terms, rational,
// radial with a fold within the image, FOV, or one of two fish-eyes.
CameraPair RandomDistortedPair(uint64_t seed);

// Returns a pair as in a grid rig. The LF camera is `column` pitches to the right of the render
// camera and `row` pitches below it, in its lens plane and parallel to it. One LF pixel is as large
// as one element. Accepted rays may lie exactly on the rim of the lens and on element borders.
CameraPair ParallelPair(int column, int row, double pitch_w, double radius_w);

}  // namespace lf::testing
