// SPDX-License-Identifier: Apache-2.0
// Changes the number of pixels of an image, for the same picture.
#pragma once

#include "lf/camera/pinhole.h"

namespace lf {

// Adapts K to an image that has `factor` times as many pixels along each side for the same picture.
// Changes neither width nor height, which callers round as they need it.
inline void ScaleResolution(double factor, Intrinsics* k) {
  k->fx_px *= factor;
  k->fy_px *= factor;
  k->cx_px *= factor;
  k->cy_px *= factor;
  k->skew_px *= factor;
}

// Returns the intrinsics of the image of which each pixel is a square of divisor x divisor pixels.
// Columns and rows on the right and below that do not fill a square are cut off, but at least one
// pixel is left.
inline Intrinsics WithLargerPixels(Intrinsics k, int divisor) {
  ScaleResolution(1.0 / divisor, &k);
  k.width_px = k.width_px < divisor ? 1 : k.width_px / divisor;
  k.height_px = k.height_px < divisor ? 1 : k.height_px / divisor;
  return k;
}

}  // namespace lf
