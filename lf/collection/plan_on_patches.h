// Plans the spans of LF cameras with lens distortion. Internal to collection.
#pragma once

#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/segments.h"

namespace lf {

// Appends the accepted pixels of `rect`. Control points tell if a patch (camera/ideal_pixels.h) is
// wholly accepted, wholly rejected, or undecided. Undecided patches are cut into scanlines and
// halves of scanlines, and finally the ray model decides ray by ray.
void PlanScatterOnPatches(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          const PixelRect& rect, const IdealPixels& ideal_pixels,
                          std::vector<Segment>* segments);

}  // namespace lf
