// SPDX-License-Identifier: Apache-2.0
// Plans the scatter segments of LF cameras with lens distortion. Internal to collection.
#pragma once

#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/segments.h"

namespace lf {

// Appends the segments of the accepted pixels of `rect`. The control points of a patch
// (camera/ideal_pixels.h) tell if all its rays are accepted, all are rejected, or the patch is
// undecided. An undecided patch is halved until the edges of lens and plate bound its scanlines
// (patch_edges.h) or few scanlines are left. Scanlines that the edges cannot bound are halved, and
// finally the ray model decides ray by ray.
void PlanScatterOnPatches(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          const PixelRect& rect, const IdealPixels& ideal_pixels,
                          std::vector<Segment>* segments);

}  // namespace lf
