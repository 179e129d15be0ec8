// SPDX-License-Identifier: Apache-2.0
// Computes the order of the LF images (selection/image_order.h) from the needs of all frames of a
// film.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/selection/image_order.h"

namespace lf {

// Returns the rank of every LF image in the order. The order is computed for all frames of the
// film, even if only some are rendered, so that a rank means the same for any choice of frames.
// If DependsOnFrames(order) is true, LF images that no frame reads (FrameNeeds::images) come last.
//   needs  options with which the film will be rendered; max_image_count is ignored
// kInterrupted: *needs.select.interrupted became true; never if DependsOnFrames(order) is
// false.
Result<ImageRanks> RanksOfFilm(ImageOrder order, uint64_t seed, const LightField& light_field,
                               const CameraPath& path, const NeedsOptions& needs, ThreadPool& pool);

}  // namespace lf
