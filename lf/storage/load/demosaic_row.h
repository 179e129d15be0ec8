// SPDX-License-Identifier: Apache-2.0
// The inner loop of demosaicing. Internal to this folder.
#pragma once

#include <cstdint>

namespace lf {

// Factors of the Laplacians, for one row of a mosaic, in units of 1/4096. They multiply integer
// Laplacians. A row of a mosaic holds G and either R or B, which is called C here; D is the colour
// that the row lacks.
struct RowGains {
  // Factors for the colours G and D at a pixel of C. The Laplacian there is four times this C, less
  // the four C that are 2 pixels away.
  int32_t g_at_c = 0;
  int32_t d_at_c = 0;
  // Factors for the colours C and D at a pixel of G. The Laplacian there is ten times this G, less
  // a weighted sum of the G around the pixel.
  int32_t c_at_g = 0;
  int32_t d_at_g = 0;
};

// Computes the RGB pixels of `pair_count` pairs of mosaic pixels. The first pixel of a pair
// recorded C, the second recorded G.
//   rows  mosaic rows y - 2 to y + 2, at the first pair; two values before the first pair and two
//         after the last pair are read
//   rgb   [pair_count][2][4]: the lanes R, G, B, 1 of LfPixels
void DemosaicPairs(const uint16_t* const rows[5], bool c_is_red, const RowGains& gains,
                   int pair_count, uint16_t* rgb);

}  // namespace lf
