// Outlines the part of an LF image from which a frame may take rays (thesis Fig. 4.5).
#pragma once

#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// Returns the part of the LF image that shows both the lens and what the plate sees on the focus
// plane: convex polygons in continuous pixel coordinates, at most two (a tilted focus plane has two
// sides). With lens distortion, straight edges are bent as the lens bends them; the result is empty
// if the lens sees too wide for a bounding polygon.
std::vector<std::vector<Vec2>> OverlapOutlines(const PinholeCamera& lf_camera,
                                               const RenderCamera& render_camera);

}  // namespace lf
