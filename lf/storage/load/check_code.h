// SPDX-License-Identifier: Apache-2.0
// Checks the head of an encoded image before memory is allocated for its pixels. Internal to this
// folder.
#pragma once

#include <string_view>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

// Returns the number of bits of the stored values of an encoded image.
inline int BitsOf(StoredValues values) { return values == StoredValues::kUint8 ? 8 : 16; }

// Checks the head of an encoded image against the store's table and the encoding. Returns kInput,
// with a message that does not name the LF image, if it differs.
//   grey_too  a grey image is valid in place of `layout`
Result<void> CheckCode(std::string_view bytes, int bits, PixelLayout layout, bool grey_too,
                       const PixelRect& rect);
// Checks the colours, or the mosaic, of an LF image.
Result<void> CheckColours(std::string_view bytes, const PackedCode& code, BayerPattern bayer);

}  // namespace lf
