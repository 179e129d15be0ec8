// SPDX-License-Identifier: Apache-2.0
// Computes the thin-lens camera of every frame from the description of a path.
#pragma once

#include "lf/camera/path/camera_path.h"
#include "lf/camera/path/path_description.h"
#include "lf/core/result.h"

namespace lf {

// Returns the cameras of frames 1, 2, ...: the camera of frame i has the state at time (i - 1) /
// fps. With a shutter, also returns the cameras of the instants of every frame, each with the state
// at its own time: all quantities move while a frame is exposed. The instants of the first frames
// may be before time 0, where speeds continue backwards and keyframes hold their first value.
// Elements are squares. The principal point is the centre of the plate, unless camera.shift moves
// the plate.
//
// kInput, with frame, time, quantity and its position in the file, if at some frame or instant
//   a quantity is out of its range: an aperture below 0, a focus distance of 0, a tilt of 90
//   degrees
//   the camera is at the point that it looks at, or looks along `up`
//   the focus point, or the point where the focus plane meets the optical axis, is not in front of
//   the lens
//   the horizontal field of view is almost 0 or 180 degrees, or the aperture is wider than 1e9
//   world units
//   lens.breathing is true and the focus distance does not exceed the focal length
Result<CameraPath> EvaluatePath(const PathDescription& path);

}  // namespace lf
