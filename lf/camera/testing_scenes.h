// Random pairs of an LF camera and a render camera for tests: before, behind and in the lens
// plane, tilted focus planes with their horizon in view, disks and polygons, turned images.
#pragma once

#include <cstdint>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"

namespace lf::testing {

struct CameraPair {
  PinholeCamera lf_camera;
  RenderCamera render_camera;
};

// LF images are 50 x 35 pixels, plates 160 x 120. The kind of scene cycles with the seed.
CameraPair RandomCameraPair(uint64_t seed);

// As RandomCameraPair(), with an LF image of 200 x 140 pixels taken through a lens that bends the
// rays: a phone's, with or without tangential terms, with a fold within the image, or a fish-eye.
CameraPair RandomDistortedPair(uint64_t seed);

// A grid rig: LF camera (column, row) pitches beside the render camera, all parallel, in the lens
// plane, one LF pixel per element. Accepted rays sit exactly on rims and element borders.
CameraPair ParallelPair(int column, int row, double pitch_w, double radius_w);

}  // namespace lf::testing
