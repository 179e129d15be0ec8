// SPDX-License-Identifier: Apache-2.0
// Computes RGB pixels from the mosaic of a Bayer sensor, for the estimator that interpolates RGB.
//
// Malvar, He and Cutler, "High-quality linear interpolation for demosaicing of Bayer-patterned
// color images" (ICASSP 2004). A pixel keeps the colour d that it recorded. Another colour c is
//   M[c] + gain (w[d] / w[c]) L.
// M[c] is the mean of the nearest pixels that recorded c. L (the Laplacian) is the pixel's value
// minus a weighted mean of other pixels of colour d in its 5 x 5 neighbourhood. w holds the factors
// of the white balance. The gains are the paper's: 1/2 for G at R or B, 5/8 for R or B at G, 3/4
// for R at B and B at R.
//
// - Reason for w: a grey detail has equal height in all colours only after white balance. In the
//   mosaic, which is not balanced, the height is proportional to 1 / w. The factor w[d] / w[c]
//   turns the height of L, which is measured in d, into the height in c.
// - M[c] and L are exact. The ratio w[d] / w[c] has steps of 1/256 and is limited to 8, because a
//   larger factor would mostly amplify noise. Sums are integers, rounded half up and clipped to
//   0..65535, so that the result has the same bits on every machine.
// - L is 0 where the radiance is constant or a linear ramp: a pedestal is preserved, and ramps are
//   exact.
// - Positions beyond the image are mirrored about its outermost pixels (-1 is 1, -2 is 2), where
//   the mosaic has the same colour.
#pragma once

#include <array>

#include "lf/core/geometry.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// Returns the mosaic pixels from which the RGB pixels `rect` are computed: `rect` and 2 pixels more
// on each side, clipped to the image.
PixelRect MosaicRectOf(const PixelRect& rect, int image_width_px, int image_height_px);

// Computes the RGB pixels `rect`, which lies in an LF image of at least 2 x 2 pixels. A pixel is
// masked if a mosaic pixel at an offset (dx, dy) with |dx| + |dy| <= 2 is masked. A pixel's value
// does not depend on `rect`.
//   mosaic         holds at least the pixels MosaicRectOf(rect)
//   white_balance  factors of R, G and B that make grey surfaces grey; above 0
//   rgb            the result, whose memory is reused; must be another object than `mosaic`
void Demosaic(const LfPixels& mosaic, int image_width_px, int image_height_px,
              const std::array<double, 3>& white_balance, const PixelRect& rect, LfPixels* rgb);

// Computes the same pixels as Demosaic(), bit for bit, literally by the formula, one pixel at a
// time.
void DemosaicReference(const LfPixels& mosaic, int image_width_px, int image_height_px,
                       const std::array<double, 3>& white_balance, const PixelRect& rect,
                       LfPixels* rgb);

}  // namespace lf
