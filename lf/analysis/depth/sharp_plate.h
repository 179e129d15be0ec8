// SPDX-License-Identifier: Apache-2.0
// Collects a picture in which everything is in focus: every element has a focus distance of its
// own. Internal to this folder.
#pragma once

#include <span>

#include "lf/analysis/depth/lens_views.h"
#include "lf/camera/render_camera.h"
#include "lf/core/image.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/render/collect/frame_lens.h"

namespace lf {

// Adds the light of row y of the plate. The lens is a pinhole whose weights interpolate between the
// LF cameras around it (LensWeights::kHat), so that a wrong depth blurs little. LF images are
// interpolated by Catmull-Rom splines in linear light.
//   depths_w  [height][width] distances along the optical axis, all above 0
void AddSharpRow(std::span<const LensView> views, const RenderCamera& frame, const FrameLens& lens,
                 const Image<float>& depths_w, int y, SensorPlate* plate);

}  // namespace lf
