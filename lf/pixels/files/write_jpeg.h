// SPDX-License-Identifier: Apache-2.0
// Encodes JPEG files in memory, for web pages.
#pragma once

#include <cstdint>
#include <string>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Returns the bytes of a baseline JPEG file, with chroma halved in both directions.
//   pixels   [height][width][3] sRGB; width and height are 1 to 65500
//   quality  1 to 100
// kOutput: a side exceeds 65500 pixels, or memory is lacking.
Result<std::string> EncodeJpeg(ImageView<const uint8_t> pixels, int quality);

}  // namespace lf
