// SPDX-License-Identifier: Apache-2.0
// The inner loops of demosaicing. Internal to this folder.
//
// The four phases of a mosaic are split into rows of their own: a phase holds the pixels of one
// parity of column and row. Element k of a row is a pixel of the square k, the 2 x 2 pixels whose
// columns are 2 k and 2 k + 1. Each function computes elements [0, count) of its result, whose
// memory must not overlap that of its inputs.
#pragma once

#include <array>
#include <cstdint>

namespace lf {

// Roots of step 0. The two pixels of a square alternate in `mosaic`.
//   mosaic  [count][2]
//   factor  for the pixels of even and of odd columns (BalancedLevels)
void RootRows(const uint16_t* mosaic, float pedestal, const std::array<float, 2>& factor, int count,
              float* even, float* odd);

// Roots at the sites of a row, and at the pixels that are 1, 2 and 3 to the west, east, north and
// south of each.
struct CrossRows {
  const float* centre;
  std::array<const float*, 3> west, east, north, south;
};
// Green at sites of R or B (step 1).
void GreenRow(const CrossRows& cross, int count, float* green);

// The products dC dG and dG^2 of step 2.
//   colour, green  a row of the sites of C, and the row of sites below it; element `count` of the
//                  first row is read
void DetailRow(const std::array<const float*, 2>& colour, const std::array<const float*, 2>& green,
               int count, float* products, float* squares);

// The detail gains of step 2.
//   products, squares  five rows; from 2 elements before the first one to 2 after the last one
//   sums               memory for 2 (count + 4) elements
void GainRow(const std::array<const float*, 5>& products,
             const std::array<const float*, 5>& squares, int count, float* sums, float* gain);

// Roots of a colour at four neighbours and green there. Neighbours 0 and 1 lie opposite to each
// other, and so do 2 and 3.
struct NeighbourRows {
  std::array<const float*, 4> colour, green;
};
// A colour at sites that did not record it (steps 3 and 4).
//   green, gain   at the sites
//   is_diagonal   true for step 3; otherwise neighbours 2 and 3 have kInterpolatedShare
void ColourRow(const NeighbourRows& neighbours, const float* green, const float* gain,
               bool is_diagonal, int count, float* out);

// One row of RGB pixels (step 5). A row of a mosaic holds G and either R or B, which is called C
// here; D is the colour that the row lacks.
struct RowColours {
  bool c_is_red, c_is_even;      // true if C is R; true if the even columns recorded C
  const uint16_t* mosaic;        // [count][2]
  const float *g_at_c, *d_at_c;  // roots at the pixels of C
  const float *c_at_g, *d_at_g;  // roots at the pixels of G
  float pedestal;
  std::array<float, 3> inverse;  // BalancedLevels
};
//   rgb  [count][2][4]: the lanes R, G, B, 1 of LfPixels
void RgbRow(const RowColours& colours, int count, uint16_t* rgb);

}  // namespace lf
