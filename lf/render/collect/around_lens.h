// The LF cameras that a lens looks through, and how far apart they are there.
#pragma once

#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/selection/image_index.h"

namespace lf {

// Returns the LF cameras that see the middle of the plate through the lens, and some beside them.
// If fewer than a dozen do, the lens is widened until a dozen do. Ascending.
std::vector<LfImageId> CamerasAroundLens(const ImageIndex& index, const RenderCamera& frame);

// Returns about how far apart these LF cameras are as seen through the lens
// (selection/lens_weights/frame_weights.h). 0 if there is none.
double CameraDistanceAround(const ImageIndex& index, const RenderCamera& frame);

// True if the point lies within the picture of the LF camera.
bool IsSeenBy(const RayThrough& lf_camera, const Vec3& point_world);

}  // namespace lf
