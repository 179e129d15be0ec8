// The part of an LF image that a frame may take rays from, to be drawn (thesis Fig. 4.5).
#pragma once

#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// Where the LF image shows the lens and what the plate sees on the focus plane at once: convex
// polygons in continuous pixel coordinates, two at most (a tilted focus plane has two sides). Of
// LF images with distortion the straight edges are bent as the lens bends them; empty where it sees
// too wide for a polygon to bound it.
std::vector<std::vector<Vec2>> OverlapOutlines(const PinholeCamera& lf_camera,
                                               const RenderCamera& render_camera);

}  // namespace lf
