// SPDX-License-Identifier: Apache-2.0
// Lets the camera of an example path move once around an ellipse.
#pragma once

#include "lf/focus/moves/shot.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns an orbit: an ellipse around Shot::start, in the plane of its image, or beside it.
//
// The positions allow an ellipse along which the lens stays within Shot::reach: its semi-axes are
// reach - lens radius. A calm film is at most 8 degrees wide as seen from the subject, moves by 6
// degrees a second, and takes 2 to 4 seconds. If LF cameras have not recorded 99 % of each of its
// frames, smaller ones are tried, cropped frames, and ellipses half as large that begin at
// Shot::start and lie to its left or right, for LF cameras at the border of a capture. The orbit
// has the largest size times crop. If LF cameras have recorded 99 % of none, it is the one of which
// they have recorded most, and CameraMove::warning says so. An element counts as recorded if an LF
// camera sees its point on the focus plane through the lens, or through a lens as wide as two
// spacings of LF cameras, if that is wider.
CameraMove MakeOrbit(const LightField& light_field, const Shot& shot);

}  // namespace lf
