// DecodeImage() with a chosen implementation of the transforms. Internal to codec.
#pragma once

#include <string_view>

#include "lf/codec/lf_image_codec.h"
#include "lf/codec/wavelet53.h"

namespace lf {

Result<void> DecodeImageBy(Transform transform, std::string_view code, const PixelRect& wanted,
                           DecodedPart* part);

}  // namespace lf
