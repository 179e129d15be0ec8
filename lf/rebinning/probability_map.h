// SPDX-License-Identifier: Apache-2.0
// The probability p that the ray of an LF pixel is kept: p is higher where the image changes more
// around the pixel (thesis 4.3.2, Eq. 4.4, Figure 4.8).
//
// LoG is the Laplacian of the image smoothed by a Gaussian:
//
//   p(x, y) = min(1, |LoG(x, y)| alpha + xi)  where |LoG(x, y)| >= beta,  else 0
//
// The image has stored values, not linear light: in stored values, noise is about as strong in
// shadows as in highlights. All arithmetic is in integers, so that every machine keeps the same
// rays.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/image.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/radiance.h"
#include "lf/rebinning/rebin_options.h"

namespace lf {

// Returns a table of 65536 stored values, 0 for black to 65535 for white: one for each 16-bit
// linear value (light_field/model/radiance.h). It is the inverse of RadianceTable() with a gain of
// 1.
std::vector<uint16_t> StoredValueTable(const RadianceEncoding& encoding);

// Computes p of the pixels of `rect`, a part of pixels.rect, in units of 1 / 65535.
//
// The image of a mosaic is the mean of the two greens of every 2 x 2 pixels (at even positions in
// the LF image). The unit of sigma is still the LF pixel, and all four pixels have the same p.
//
// The image continues beyond the borders of pixels.rect with its outermost values: for exact
// results, pixels.rect must be larger than `rect` by PixelsAround() pixels on each side that is not
// a border of the LF image. Masked pixels have p = 0.
//   p  [rect.height][rect.width]; its memory is reused
void ProbabilityMap(const LfPixels& pixels, const PixelRect& rect,
                    const std::vector<uint16_t>& stored_values, const ProbabilityOptions& options,
                    Image<uint16_t>* p);

// Returns the largest distance, in LF pixels, between a pixel and another pixel that its p depends
// on.
int PixelsAround(const ProbabilityOptions& options, bool is_mosaic);

// The reference of ProbabilityMap(). Computes p pixel by pixel.
void ProbabilityMapReference(const LfPixels& pixels, const PixelRect& rect,
                             const std::vector<uint16_t>& stored_values,
                             const ProbabilityOptions& options, Image<uint16_t>* p);

}  // namespace lf
