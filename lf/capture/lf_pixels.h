// The pixels of one LF image, ready for collection.
#pragma once

#include <cstdint>

#include "lf/core/geometry.h"
#include "lf/core/image.h"

namespace lf {

struct LfPixels {
  // v of every pixel (capture/radiance.h)  [height][width][1] of a mosaic, [height][width][3] RGB
  Image<uint16_t> radiance;
  BayerPattern bayer = BayerPattern::kNone;  // at pixel (0, 0) of the whole LF image
  Image<uint8_t> mask;  // empty, or [height][width]: 0 = no ray from this pixel
  PixelRect rect;       // the part of the LF image that these pixels are

  size_t size_bytes() const { return radiance.size_bytes() + mask.size_bytes(); }
};

}  // namespace lf
