// From the description of a path to the thin-lens camera of every frame.
#pragma once

#include "lf/core/result.h"
#include "lf/path/camera_path.h"
#include "lf/path/path_description.h"

namespace lf {

// The cameras of frames 1, 2, ...: frame i is the state at time (i - 1) / fps, without motion blur.
// Elements are squares, the principal point is the centre of the plate.
//
// kInput, with frame, time, quantity and its place in the file, if at some frame
//   a quantity leaves its range: an aperture below 0, a focus distance of 0, a tilt of 90 degrees
//   the camera stands on the point it looks at, or looks along `up`
//   the focus point is not in front of the lens
//   `breathing` and the focus distance does not exceed the focal length
Result<CameraPath> EvaluatePath(const PathDescription& path);

}  // namespace lf
