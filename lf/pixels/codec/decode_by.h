// SPDX-License-Identifier: Apache-2.0
// DecodeImage(), DecodePredicted() and DecodeReduced() with a chosen implementation of the
// transforms. Internal to this folder.
#pragma once

#include <span>
#include <string_view>

#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/pixels/codec/wavelet53.h"

namespace lf {

Result<void> DecodeImageBy(Transform transform, std::string_view code, const PixelRect& wanted,
                           DecodedPart* part);
Result<void> DecodePredictedBy(Transform transform, std::string_view code,
                               std::span<const DecodedPart* const> references,
                               const PixelRect& wanted, DecodedPart* part);
Result<void> DecodeReducedBy(Transform transform, std::string_view code, int reduction,
                             CodecPixels* pixels);

}  // namespace lf
