// SPDX-License-Identifier: Apache-2.0
// Computes RGB pixels from the mosaic of a Bayer sensor, for the estimator that interpolates RGB.
//
// A pixel keeps the colour that it recorded, bit for bit. Other colours are means of neighbours. A
// neighbour counts less across edges, and its value is corrected by the detail of another colour.
//
//   0. Roots. A radiance x (1 = display white), times the factor of the white balance of its
//      colour, becomes a root s(x): x + 0.01 = s |s|. Errors at bright lights then do not swamp
//      their surroundings, and noise is about even.
//   1. Green at a site of R or B. The neighbour at distance 1 to the west gives the estimate
//      w1 + (c - w2) / 2 and the gradient |w1 - e1| + 0.01 + |c - w2| + |w1 - w3|; c is the root at
//      the site, w and e are roots to the west and east. The other three directions give estimates
//      in the same way. Green is their mean, weighted by 1 / gradient, and limited to the range
//      of the four neighbours, so that it does not overshoot beside lights.
//   2. Detail gains, at each site of C = R or B: how much of the detail of green C shows. It is
//      (sum dC dG + 0.001) / (sum dG^2 + 0.001), at least 0 and at most 2. The sums run over 5 x 5
//      sites of C and the differences d to the next site of C to the right and to the next below.
//   3. R at sites of B, and B at sites of R. A diagonal neighbour with the root a and the green ga
//      gives the estimate a + gain (g - ga) and the gradient 0.02 + |a - b| / 2 + |g - ga|; b is
//      the root opposite to a, g the green at the site, and the gain is that of the 2 x 2 pixels
//      around the site. The mean of four is weighted by 1 / gradient.
//   4. R and B at sites of G, in the same way, from the four nearest neighbours. The two of them
//      that step 3 interpolated have half the weight.
//   5. Roots become radiance again. Values are rounded half up and clipped to 0..65535; a pedestal
//      is preserved.
//
// - All steps are single precision with a fixed order of operations. Results have the same bits on
//   every machine.
// - Positions beyond the image are mirrored about its outermost pixels (-1 is 1, -2 is 2), where
//   the mosaic has the same colour.
// - A masked mosaic pixel has no value of its own. Before step 0 it is replaced by the mean,
//   rounded half up, of the unmasked ones among the 8 pixels of the same colour at distance 2
//   (|dx| and |dy| are 0 or 2). If all of them are masked, it keeps its value.
// - Constant colours are exact. The method is not linear: errors beside small lights and dark spots
//   do not vanish entirely in the mean of many LF images.
#pragma once

#include "lf/core/geometry.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/radiance.h"

namespace lf {

// Returns the mosaic pixels from which the RGB pixels `rect` are computed: `rect` and 13 pixels
// more on each side, clipped to the image.
PixelRect MosaicRectOf(const PixelRect& rect, int image_width_px, int image_height_px);

// Computes the RGB pixels `rect`, which lies in an LF image of at least 2 x 2 pixels. A pixel is
// masked if a mosaic pixel at an offset (dx, dy) with |dx| + |dy| <= 2 is masked. A pixel's value
// does not depend on `rect`.
//   mosaic    holds at least the pixels MosaicRectOf(rect); its pattern is mosaic.bayer
//   encoding  its scale, pedestal and white balance are used
//   rgb       the result, whose memory is reused; must be another object than `mosaic`
void Demosaic(const LfPixels& mosaic, int image_width_px, int image_height_px,
              const RadianceEncoding& encoding, const PixelRect& rect, LfPixels* rgb);

// Computes the same pixels as Demosaic(), bit for bit, literally by the formulas, one pixel at a
// time.
void DemosaicReference(const LfPixels& mosaic, int image_width_px, int image_height_px,
                       const RadianceEncoding& encoding, const PixelRect& rect, LfPixels* rgb);

}  // namespace lf
