// SPDX-License-Identifier: Apache-2.0
// Outlines the part of an LF image from which a frame may take rays (thesis Fig. 4.5).
#pragma once

#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// Returns the part of the LF image that sees both the render lens and the region of the focus plane
// that the plate sees: at most two convex polygons in continuous pixel coordinates (the LF camera
// may see both sides of a tilted focus plane). If the LF camera has lens distortion, straight edges
// are bent as its lens bends them. The result is empty if there is no such part, or if the field of
// view of the LF camera is too wide for a bounding polygon.
std::vector<std::vector<Vec2>> OverlapOutlines(const PinholeCamera& lf_camera,
                                               const RenderCamera& render_camera);

}  // namespace lf
