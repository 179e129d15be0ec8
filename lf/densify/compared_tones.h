// SPDX-License-Identifier: Apache-2.0
// Tones of an LF image for the comparison with others whose light differs a little.
#pragma once

#include <cstdint>

#include "lf/core/image.h"

namespace lf {

// Returns the tones of a working image with half of their local mean in R, G and B: t - m / 2 + 64,
// limited to 0 and 255, where m is the mean over the pixels around it, up to 4 away in x and y,
// that are neither masked nor transparent. Exposures, falloff and the sheen of surfaces differ
// between photographs, and change m; detail, which tells the depth, keeps its contrast. At the
// border of an image, m is that of other surroundings, and depths are less exact by up to 0.4
// pixels of shift. Opacities, and pixels that are masked or transparent, are returned as they are.
//   tones  WorkingImage::tones
Image<uint16_t> ComparedTones(const Image<uint16_t>& tones);

}  // namespace lf
