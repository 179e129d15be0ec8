// The spans of LF cameras with lens distortion. Internal to collection.
#pragma once

#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/segments.h"

namespace lf {

// Appends the accepted pixels of `rect`. By their control points patches (camera/ideal_pixels.h)
// are wholly accepted, wholly rejected, or undecided; then their scanlines are asked, halves of
// these, and at last the law, ray by ray.
void PlanScatterOnPatches(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          const PixelRect& rect, const IdealPixels& ideal_pixels,
                          std::vector<Segment>* segments);

}  // namespace lf
