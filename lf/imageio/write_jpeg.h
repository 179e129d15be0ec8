// JPEG files in memory, for pages.
#pragma once

#include <cstdint>
#include <string>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// The bytes of a JPEG file, baseline, with chroma halved in both directions.
//   pixels   [height][width][3] sRGB, at most 65500 each way, not empty
//   quality  1 to 100
// kOutput: no memory.
Result<std::string> EncodeJpeg(ImageView<const uint8_t> pixels, int quality);

}  // namespace lf
