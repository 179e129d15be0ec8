// SPDX-License-Identifier: Apache-2.0
// A mosaic as the picture of its squares of 2 x 2 pixels, which have four channels: the pixels at
// (even, even), (odd, even), (even, odd) and (odd, odd) columns and rows. Predictions move each
// colour for itself in this form. Internal to this folder.
#pragma once

#include "lf/core/image.h"

namespace lf {

// Returns the squares, [(height + 1) / 2][(width + 1) / 2][4]. Where a column or row of the mosaic
// is missing because its size is odd, the squares repeat the one before.
//   mosaic  at least 1 x 1 pixels
template <class Pixel>
Image<Pixel> SquaresOf(ImageView<const Pixel> mosaic) {
  Image<Pixel> squares((mosaic.width + 1) / 2, (mosaic.height + 1) / 2, 4);
  for (int y = 0; y < squares.height(); ++y) {
    const Pixel* const upper = mosaic.row(2 * y);
    const Pixel* const lower = mosaic.row(2 * y + 1 < mosaic.height ? 2 * y + 1 : 2 * y);
    Pixel* const out = squares.row(y);
    const int whole = mosaic.width / 2;
    for (int x = 0; x < whole; ++x) {
      out[4 * x] = upper[2 * x];
      out[4 * x + 1] = upper[2 * x + 1];
      out[4 * x + 2] = lower[2 * x];
      out[4 * x + 3] = lower[2 * x + 1];
    }
    if (whole < squares.width()) {
      out[4 * whole] = out[4 * whole + 1] = upper[2 * whole];
      out[4 * whole + 2] = out[4 * whole + 3] = lower[2 * whole];
    }
  }
  return squares;
}

// Writes the pixels of squares into a mosaic that they cover.
template <class Pixel>
void ToMosaic(const Image<Pixel>& squares, ImageView<Pixel> mosaic) {
  for (int y = 0; y < mosaic.height; ++y) {
    const Pixel* const in = squares.row(y / 2) + 2 * (y % 2);
    Pixel* const out = mosaic.row(y);
    const int whole = mosaic.width / 2;
    for (int x = 0; x < whole; ++x) {
      out[2 * x] = in[4 * x];
      out[2 * x + 1] = in[4 * x + 1];
    }
    if (mosaic.width % 2 == 1) out[2 * whole] = in[4 * whole];
  }
}

}  // namespace lf
