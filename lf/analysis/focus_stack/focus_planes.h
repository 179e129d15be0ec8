// SPDX-License-Identifier: Apache-2.0
// The planes of a focus stack: pictures of one camera that differ only in their focus distance.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Limits of a focus stack, which are checked before memory is allocated.
inline constexpr size_t kMostFocusPlanes = 10'000;
inline constexpr double kLeastFocusDistance_w = 1e-9;
inline constexpr double kMostFocusDistance_w = 1e9;

// Returns `count` distances from range.near_w to range.far_w. They are even in 1 / distance,
// because the displacement of a point from one LF image to another is even in it: between two
// neighbouring planes, a point moves by the same number of elements anywhere in the stack. A single
// plane is in the middle of 1 / near_w and 1 / far_w. The range must have 0 < near_w <= far_w.
std::vector<double> EvenFocusDistances(const DepthRange& range, size_t count);

// Parses a length in world units, such as "0.4", or in millimetres, "400mm". Returns world units.
// kUsage: the text has another form, or the length is not from kLeastFocusDistance_w to
// kMostFocusDistance_w; the message begins with `what`, such as "{near}".
//   unit_m  metres per world unit
Result<double> ParseFocusDistance(std::string_view text, std::string_view what, double unit_m);

// Parses focus distances as ParseFocusDistance() does, in any order. They are separated by commas,
// blanks or line breaks; a '#' begins a comment that ends with the line.
//   what  name in messages, such as "{distances}" or the name of a file, which the number of the
//         line follows
// kUsage: a distance is wrong, there is none, or there are more than kMostFocusPlanes.
Result<std::vector<double>> ParseFocusDistances(std::string_view text, std::string_view what,
                                                double unit_m);

// Returns the camera with its focus plane at another distance along the optical axis. The tilt of
// the plane is kept. The field of view is kept, unless the lens breathes: if the field of view of
// `camera` follows from 1/f = 1/g + 1/b (thesis Eq. 2.8) and not from b = f, so does that of the
// returned camera. The result has the same bits as a path that states this distance.
// kInput: the lens breathes and the distance does not exceed its focal length. kUsage: the camera
// has a focal surface, which has no focus distance.
Result<RenderCamera> FocusedAt(const RenderCamera& camera, double focus_distance_w);

// Returns a path of one frame for each distance: the camera of frame `frame` of `path`, focused
// there. With a shutter, the cameras at its instants are focused there as well. Errors as
// FocusedAt(); the message states the distance.
Result<CameraPath> FocusStackPath(const CameraPath& path, FrameId frame,
                                  std::span<const double> distances_w);

// Finds the depths of the scene in front of a camera: those that the calibration states
// (LightField::depth_range), otherwise those that are found by comparing LF images
// (focus/swept_depths.h). Both are depths of the LF camera nearest to the lens. They are converted
// to distances along the axis of `camera`: the nearest and the farthest of the corners and the
// middle of that LF camera's view at these depths.
//   advice  says at the end of the error how to state them, such as ", by --near and --far"
// kInput: the depths are neither stated nor found, or are not in front of the camera.
Result<DepthRange> FindFocusRange(const LightField& light_field, const RenderCamera& camera,
                                  ThreadPool& pool, std::string_view advice = "");

}  // namespace lf
