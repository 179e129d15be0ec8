// SPDX-License-Identifier: Apache-2.0
// Reads how much of the light behind each pixel of an LF image is covered, and composes pixels with
// the background if alpha is light (RadianceEncoding::alpha). Internal to this folder.
#pragma once

#include <cstdint>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/image_reading.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {

// Reads the opacities of the pixels `rect`, which lies in part.rect, from the file's alpha, as
// RecordedImage::opacities. Pixels that the mask file or a bracket masks (ForEachMasked()) become
// kMaskedOpacity. Each alpha of 8 or 16 bits has an opacity of its own, except that 65534 of 16
// bits counts as opaque. Float alphas are rounded to 16 bits; NaN is transparent. kInput: the mask
// file cannot be read.
Result<Image<uint16_t>> ReadOpacities(const LightField& light_field, LfImageId id,
                                      const ImagePart& part, const ChannelUse& use,
                                      const PixelRect& rect);

// Composes the loaded pixels of pixels->rect with the background. A colour v with opacity a and
// background b becomes
//   straight       a v + (1 - a) b
//   premultiplied  v + (1 - a) (b - pedestal)
// in integers, rounded to nearest and clipped at max_radiance. Masks the pixels of kMaskedOpacity.
// Fills pixels->opacity, rounded to nearest, if encoding.HasOpacity(). `pixels` must be RGB.
//   opacities_rect  pixels of the LF image that `opacities` holds; contains pixels->rect
void ComposeWithBackground(const Image<uint16_t>& opacities, const PixelRect& opacities_rect,
                           const RadianceEncoding& encoding, LfPixels* pixels);

// Fills pixels->opacity of an LF image without alpha: pixels that are not masked are opaque.
void SetOpaque(LfPixels* pixels);

}  // namespace lf
