// SPDX-License-Identifier: Apache-2.0
// The brightness of pixels in 8 bits, in which depths are searched (block_search.h).
#pragma once

#include <cstdint>

#include "lf/core/image.h"

namespace lf {

// The values that become brightness 0 and 255.
struct BrightnessRange {
  int black = 0;
  int white = 255;
  double unit() const { return (white - black) / 255.0; }  // stored values for each step
};

// Returns 0 to 255 for pixels of 8 bits, and from the least to the greatest value for 16 bits.
template <class Pixel>
BrightnessRange RangeOf(ImageView<const Pixel> pixels);

// Returns the brightness of each pixel: of a single channel the value; of R, G, B (R + 2 G + B) /
// 4; of four channels their mean.
template <class Pixel>
Image<uint8_t> BrightnessOf(ImageView<const Pixel> pixels, const BrightnessRange& range);

}  // namespace lf
