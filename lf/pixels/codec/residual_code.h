// SPDX-License-Identifier: Apache-2.0
// Encodes and decodes the difference of an image to its prediction (predicted_image.h). Internal to
// this folder.
#pragma once

#include <string>
#include <string_view>

#include "lf/pixels/codec/code_head.h"
#include "lf/pixels/codec/wavelet53.h"

namespace lf {

// Returns the encoded image. Its head holds the number of reference images and `prediction_code`,
// the bytes that describe the prediction. Arguments are those of EncodeImage(); the profile must
// not be kThesis.
//   prediction  of the type and size of `pixels`
std::string EncodeResidual(const CodecPixels& pixels, const CodecPixels& prediction,
                           PixelLayout layout, const CodecSettings& settings, int reference_count,
                           std::string_view prediction_code);

// Returns the smallest rectangle of whole tiles that contains the pixels `wanted`.
PixelRect TilesAround(const CodeHead& head, const PixelRect& wanted);

// Decodes the tiles of `rect`, a rectangle of whole tiles. Before, `pixels` must hold the
// prediction of these pixels if the image is predicted. Errors are those of DecodeImage(), except
// that a predicted image is none.
Result<void> DecodeResidual(Transform transform, std::string_view code, const PixelRect& rect,
                            CodecPixels* pixels);

}  // namespace lf
