// SPDX-License-Identifier: Apache-2.0
// Chooses the pixels of an LF image that are kept (kept_pixels.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/ids.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/rebinning/kept_pixels.h"
#include "lf/rebinning/rebin_options.h"

namespace lf {

// Returns the kept pixels of an LF image, which is made of the pixels of the rectangles `asked`:
// all of them if `keeps_all` is true, otherwise those whose random number in [0, 1) is below their
// p (probability_map.h). The random number depends only on seed, LF image and pixel, so that the
// choice depends neither on the number of threads nor on the order of the LF images. Masked pixels
// are not kept.
//   k               intrinsics of the LF image
//   pixels          must hold the rectangles, clipped to the LF image, and should hold
//                   PixelsAround(options.probability) more pixels on each side of them that is not
//                   a border of the LF image; without these, p near their borders differs a little
//   opacity         lanes as in LfPixels::opacity, of which the first is kept, for pixels.rect;
//                   empty: the LF image has no opacities
//   stored_values   StoredValueTable() of the light field
KeptImage KeepPixels(LfImageId id, const Intrinsics& k, const LfPixels& pixels,
                     const Image<uint16_t>& opacity, std::span<const PixelRect> asked,
                     bool keeps_all, const std::vector<uint16_t>& stored_values,
                     const RebinOptions& options);

// Returns the number of pixels in at least one of the rectangles.
uint64_t PixelsIn(std::span<const PixelRect> rects);

}  // namespace lf
