// SPDX-License-Identifier: Apache-2.0
// Finds the range of inverse depths that an image shows, for the depth indices of plane_warp.h.
#pragma once

#include "lf/core/image.h"
#include "lf/pixels/prediction/plane_warp.h"

namespace lf {

// Returns the range of inverse depths of the things that an image shows, compared with another
// image of the scene. Moves of up to a quarter of the longer side are searched, from slightly
// beyond infinity on, because calibrations have errors. The search is in pictures of 200 to 400
// pixels, first of the whole range, then of what was found. Blocks count whose differences have a
// distinct minimum. Returns the whole range if there are hardly any, as in pictures without detail
// or of other scenes. Positions that are equal give {0, 1}.
//   image, other  brightness (brightness.h)
//   view          camera of `image`, along whose optical axis depths are measured
InverseDepthRange FindInverseDepths(const Image<uint8_t>& image, const PinholeView& view,
                                    const Image<uint8_t>& other, const PinholeView& other_view);

}  // namespace lf
