// RGB pixels from the mosaic of a Bayer sensor, for the estimator that interpolates RGB.
//
// Malvar, He and Cutler, "High-quality linear interpolation for demosaicing of Bayer-patterned
// color images" (ICASSP 2004). A pixel keeps the colour d that it recorded. Another colour c is
//   mean of the nearest pixels that recorded c + gain (w[d] / w[c]) L,
// L: what the pixel exceeds a weighted mean of others of colour d in its 5 x 5 by (the Laplacian);
// w: the white balance. The gains are the paper's: 1/2 for G, 5/8 for R and B at G, 3/4 for R at B
// and B at R.
//
// - Why w: a grey detail is as high in all colours once they are balanced, so L of d serves c too.
//   A mosaic is not balanced: there the detail is 1 / w high.
// - Means and L are exact. The ratio w[d] / w[c] has steps of 1/256 and ends at 8, for L is noise
//   beyond. Sums are integers, rounded half up and clipped to 0..65535: the same bits everywhere.
// - L is 0 where v is constant or a linear ramp: the pedestal survives, ramps are exact.
// - Beyond the image, positions are mirrored about its outermost pixels (-1 is 1, -2 is 2), where
//   the mosaic has the same colour.
#pragma once

#include <array>

#include "lf/capture/lf_pixels.h"
#include "lf/core/geometry.h"

namespace lf {

// The mosaic pixels that RGB pixels `rect` are made from: 2 more on each side, within the image.
PixelRect MosaicRectOf(const PixelRect& rect, int image_width_px, int image_height_px);

// The RGB pixels `rect` of an LF image of at least 2 x 2 pixels. One is masked if a mosaic pixel
// that it is made from is, one with |dx| + |dy| <= 2. Each is the same whatever `rect` is.
//   mosaic         holds MosaicRectOf(rect)
//   white_balance  the factors of R, G and B that make grey grey; above 0
//   rgb            its memory is used again; not that of `mosaic`
void Demosaic(const LfPixels& mosaic, int image_width_px, int image_height_px,
              const std::array<double, 3>& white_balance, const PixelRect& rect, LfPixels* rgb);

// The same bits by the formula, a pixel at a time.
void DemosaicReference(const LfPixels& mosaic, int image_width_px, int image_height_px,
                       const std::array<double, 3>& white_balance, const PixelRect& rect,
                       LfPixels* rgb);

}  // namespace lf
