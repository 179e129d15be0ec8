// SPDX-License-Identifier: Apache-2.0
// Pairs of an LF camera and a render camera for tests. Random pairs have LF cameras in front of,
// behind and in the lens plane of the render camera; focus planes tilted so far that their horizon
// is in view; apertures that are disks, ellipses, polygons or rounded polygons; lenses
// with a hood; images rolled about
// the optical axis.
#pragma once

#include <cstdint>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"

namespace lf::testing {

struct CameraPair {
  PinholeCamera lf_camera;
  RenderCamera render_camera;
};

// Returns a pair with an LF image of 50 x 35 pixels and a sensor plate of 160 x 120 elements. The
// seed determines all random numbers; its remainders, such as seed % 6, select the number of
// aperture blades, whether the focus plane is tilted, and where the LF camera stands.
CameraPair RandomCameraPair(uint64_t seed);

// Returns RandomCameraPair() with an LF image of 200 x 140 pixels and lens distortion. The seed
// selects one of seven distortions: radial (a phone), radial with tangential terms, rational,
// radial with a fold within the image, FOV, or one of two fish-eyes.
CameraPair RandomDistortedPair(uint64_t seed);

// Returns a pair as in a grid rig. The LF camera stands in the lens plane of the render camera,
// `column` times pitch_w to its right and `row` times pitch_w below it, and looks in the same
// direction. One LF pixel is as large as one element. The lens has the radius radius_w. Accepted
// rays may lie exactly on the rim of the lens and on element borders.
CameraPair ParallelPair(int column, int row, double pitch_w, double radius_w);

// Gives the camera a focal surface whose pieces are rectangles of about `side` elements. Returns
// false, and changes nothing, if the camera's focus plane has a horizon on the plate, or is more
// than a hundred times as far away somewhere.
//   relief  largest difference of the inverse depth of a piece from that of the focus plane, as a
//           share of it; 0: all pieces have the focus plane
bool SetRandomSurface(int side, double relief, uint64_t seed, RenderCamera* camera);

}  // namespace lf::testing
