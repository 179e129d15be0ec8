// SPDX-License-Identifier: Apache-2.0
// Finds the LF cameras whose rays pass through the lens of a frame, and the distance between these
// rays in the lens plane.
#pragma once

#include <optional>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/selection/image_index.h"

namespace lf {

// Returns the LF cameras whose line to the focus point of the plate's middle passes through the
// lens, and some LF cameras beside them. If fewer than kCamerasAround
// (selection/lens_weights/frame_weights.h) of these lines pass through the lens, the lens is
// widened until enough do, but not without limit. The ids are ascending; there are none if the
// middle of the plate has no focus point.
//   recorded_only  true: virtual LF images are passed over
std::vector<LfImageId> CamerasAroundLens(const ImageIndex& index, const RenderCamera& frame,
                                         bool recorded_only = false);

// Returns the approximate distance, in world units, between the lines of neighbouring cameras of
// CamerasAroundLens() in the lens plane (CameraDistance() in
// selection/lens_weights/frame_weights.h); 0 if there is no such LF camera.
double CameraDistanceAround(const ImageIndex& index, const RenderCamera& frame);

// Returns the position, in pixels, at which an LF camera's image shows a point; none if it lies
// beyond the borders of the image. Does not test whether something hides the point.
std::optional<Vec2> SeenAt(const RayThrough& lf_camera, const Vec3& point_world);
inline bool IsSeenBy(const RayThrough& lf_camera, const Vec3& point_world) {
  return SeenAt(lf_camera, point_world).has_value();
}

}  // namespace lf
