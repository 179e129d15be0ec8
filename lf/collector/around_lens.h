// The LF cameras that a lens looks through, and how far apart they are there.
#pragma once

#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/selection/image_index.h"

namespace lf {

// Those that see the middle of the plate through the lens, or, if these are few, through one that
// a dozen see it through; and some beside them. Ascending.
std::vector<LfImageId> CamerasAroundLens(const ImageIndex& index, const RenderCamera& frame);

// About how far apart they see through it (lens_weights/frame_weights.h). 0 if there is none.
double CameraDistanceAround(const ImageIndex& index, const RenderCamera& frame);

// Whether what is at the point is in the picture of the LF camera.
bool IsSeenBy(const RayThrough& lf_camera, const Vec3& point_world);

}  // namespace lf
