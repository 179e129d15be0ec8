// SPDX-License-Identifier: Apache-2.0
// Encodes PNG files in memory, for web pages.
#pragma once

#include <cstdint>
#include <string>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Returns the bytes of a PNG file.
//   pixels  [height][width][1 to 4] grey or sRGB, and an alpha if there are 2 or 4 channels
// kOutput: libpng reports an error.
Result<std::string> EncodePng(ImageView<const uint8_t> pixels);

}  // namespace lf
