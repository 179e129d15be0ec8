// SPDX-License-Identifier: Apache-2.0
// Fills the unknown places of a depth map. Internal to this folder.
#pragma once

#include "lf/core/image.h"

namespace lf {

// Returns the values with all unknown ones replaced: an unknown element takes a mean of known ones,
// the nearest of them most, by a pyramid of means over 2 x 2 elements. Known elements stay.
//   values   [height][width], NaN where unknown
//   weights  [height][width] of the known values in means, above 0
// If nothing is known, all values become `otherwise`.
Image<float> FilledDepths(const Image<float>& values, const Image<float>& weights, float otherwise);

}  // namespace lf
