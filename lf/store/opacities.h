// Reads how much of the light behind each pixel of an LF image is covered, and composes pixels with
// the background, where alpha is light (RadianceEncoding::alpha). Internal to store.
#pragma once

#include <cstdint>

#include "lf/capture/lf_pixels.h"
#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/store/image_reading.h"

namespace lf {

// A pixel of a picture of opacities [height][width][1]: 0 sends no ray, by the mask file; o covers
// (o - 1) / kMostOpacity of the light behind it.
inline constexpr uint16_t kMaskedOpacity = 0;
inline constexpr uint16_t kMostOpacity = 65534;

// Reads the opacities of the pixels `rect`, which lies in part.rect, from the file's alpha and the
// image's mask file. Alpha of 8 bits is exact, of 16 bits but for 65534, which counts as opaque;
// floats are rounded to 16 bits, NaN is transparent. kInput: the mask file cannot be read.
Result<Image<uint16_t>> ReadOpacities(const LightField& light_field, LfImageId id,
                                      const ImagePart& part, const ChannelUse& use,
                                      const PixelRect& rect);

// Composes pixels->rect, as it is loaded, with the background: of a colour v, opacity a and
// background b
//   straight       a v + (1 - a) b
//   premultiplied  v + (1 - a) (b - pedestal)
// in integers, rounded to nearest and clipped at 65535, and masks what sends no ray.
// Fills pixels->opacity if the encoding HasOpacity(), rounded to nearest. The pixels are R, G and
// B.
//   opacities_rect  the pixels of the LF image that `opacities` are of; pixels->rect is within
void ComposeWithBackground(const Image<uint16_t>& opacities, const PixelRect& opacities_rect,
                           const RadianceEncoding& encoding, LfPixels* pixels);

// Fills pixels->opacity of an LF image without alpha: what is not masked is opaque.
void SetOpaque(LfPixels* pixels);

}  // namespace lf
