// SPDX-License-Identifier: Apache-2.0
// Pictures that show where two pictures differ.
#pragma once

#include <cstdint>

#include "lf/core/image.h"
#include "lf/film/compare/picture_light.h"

namespace lf {

// Shows FLIP in colours from black (0) over violet and orange to light yellow (1): 8-bit sRGB
// [height][width][3].
Image<uint8_t> FlipPicture(const Image<float>& flip);

// Shows 1/2 + gain (test - reference) / 2 of sRGB values, clipped, as 8-bit sRGB
// [height][width][3]: grey where the pictures agree, brighter where the test is brighter. Undefined
// values count as black. The pictures must have equal sizes.
Image<uint8_t> SignedDifferencePicture(const PictureLight& reference, const PictureLight& test,
                                       double gain);

}  // namespace lf
