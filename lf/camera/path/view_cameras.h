// SPDX-License-Identifier: Apache-2.0
// The cameras of several views of a film: stereo pairs, and the views of a light field display.
//
// All views of a frame are parallel: they stand side by side on the right axis of its camera, and
// their plates are shifted instead of turned (off-axis; cameras are never turned towards a point),
// so that every point of the plane of convergence is at the same position in all views. A camera
// that is moved to the right by b has the principal point
//
//   cx' = cx + fx b / c
//
// where c is the distance of convergence, from the camera along its optical axis. A point at depth
// z is therefore displaced by fx b (1/c - 1/z) elements against the camera that is not moved: the
// disparity is 0 at c, and positive, in the direction of the right axis, behind it.
#pragma once

#include <optional>

#include "lf/camera/path/camera_path.h"
#include "lf/core/result.h"

namespace lf {

// Limits of the angle of QuiltPath(), in degrees.
inline constexpr double kLeastViewAngle_deg = 0.01;
inline constexpr double kMostViewAngle_deg = 170;

// Returns the camera after it is moved to the right by offset_w world units, negative to the left.
// Lens, hood and focus plane stay: a tilted focus plane is the same plane in the world, so that the
// focus distance of the moved camera differs.
//   convergence_w  c > 0
// kInput: a tilted focus plane would meet the optical axis of the moved camera behind its lens.
Result<RenderCamera> MovedAside(const RenderCamera& camera, double offset_w, double convergence_w);

// Returns the cameras of a stereo film: the left and the right eye of the first frame, of the
// second, and so on, at half the separation on both sides of the camera of the frame.
//   separation_w   distance of the eyes in world units, above 0
//   convergence_w  c, above 0; by default the focus distance of each frame
// The frame rate stays. Errors as for QuiltPath().
Result<CameraPath> StereoPath(const CameraPath& path, double separation_w,
                              std::optional<double> convergence_w);

// Returns the cameras of the views of a light field display: those of the first frame from the
// leftmost to the rightmost, those of the second, and so on. Seen from the middle of the plane of
// convergence, they fill the angle: neighbours are 2 c tan(angle / 2) / (view_count - 1) apart.
//   view_count      at least 2
//   view_angle_rad  between the outermost views, within the limits above
//   convergence_w   c, above 0; by default the focus distance of each frame
// The frame rate stays, and becomes that of the moments. kInput: the path has several views of each
// moment already; a path would have more than kMostFrames cameras; the path has a shutter; or an
// error of MovedAside(), with the frame and the view.
Result<CameraPath> QuiltPath(const CameraPath& path, int view_count, double view_angle_rad,
                             std::optional<double> convergence_w);

}  // namespace lf
