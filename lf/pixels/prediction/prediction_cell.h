// SPDX-License-Identifier: Apache-2.0
// The cells between the centres of blocks, and which pixels of reference images each of them needs
// (predict.h). Internal to this folder.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "lf/pixels/prediction/predict.h"

namespace lf {

// Pixels of a cell move in squares: all pixels of a square have the same displacement. The less
// displacements change within the cell, the larger the squares are.
inline constexpr int kSquareBits = 2;
inline constexpr int kLeastSquare = 1 << kSquareBits;
inline constexpr int kMostSquares = 1 << (kMostBlockBits - kSquareBits);  // along a cell

// Displacements have kPhaseBits fraction bits. The interpolation at a position uses kTaps pixels
// along each axis, kTapsBefore of which lie before it.
inline constexpr int kPhaseBits = 6;
inline constexpr int kPhases = 1 << kPhaseBits;
inline constexpr int kTaps = 4;
inline constexpr int kTapsBefore = 1;

// Weights of the interpolation for each phase, in 1 / 2^kTapBits; their sum is 1. They are those of
// Keys (1981) with a = -5/8, rounded, halves up; the second one makes the sum exact. Predicted
// images were longest with two taps, and longer with six and eight than with four.
inline constexpr int kTapBits = 7;
using Taps = std::array<int16_t, kTaps>;
constexpr std::array<Taps, kPhases> MakeTaps() {
  std::array<Taps, kPhases> all{};
  for (int p = 0; p < kPhases; ++p) {
    // With t = p / 64: 80 (-t^3 + 2 t^2 - t), 16 (-11 t^3 + 14 t^2 + 5 t) and 80 (t^3 - t^2).
    const auto rounded = [](int numerator) { return (numerator + 8192) >> 14; };
    Taps& taps = all[p];
    taps[0] = static_cast<int16_t>(rounded(-5 * p * p * p + 640 * p * p - 20480 * p));
    taps[2] = static_cast<int16_t>(rounded(-11 * p * p * p + 896 * p * p + 20480 * p));
    taps[3] = static_cast<int16_t>(rounded(5 * p * p * p - 320 * p * p));
    taps[1] = static_cast<int16_t>((1 << kTapBits) - taps[0] - taps[2] - taps[3]);
  }
  return all;
}
inline constexpr std::array<Taps, kPhases> kTapsOfPhase = MakeTaps();

// The sum of the weights of a pixel is 2^kWeightBits. The weight of a block is the product of three
// numbers: across and down up to kWindow, and the share of a reference image in the mean, up to
// kShare.
inline constexpr int kWeightBits = 14;
inline constexpr int kWindow = 32;
inline constexpr int kShare = 16;

// Returns the weight of the right of two blocks at the column `offset` of a cell; the left block
// has the rest of kWindow. It is 0 in the first quarter of the cell, kWindow in the last quarter,
// and rises evenly in between. Rows are weighted in the same way.
inline int WindowOfNext(int offset, int block_bits) {
  const int quarter = 1 << (block_bits - 2);
  return std::clamp((2 * (offset - quarter) + 1) * kWindow >> block_bits, 0, kWindow);
}

// The share of each reference image in the prediction of a block, for each mask: kShare is divided
// equally, and the first of three gets the rest.
using Shares = std::array<uint8_t, kMostReferences>;
constexpr std::array<Shares, 1 << kMostReferences> MakeShares() {
  std::array<Shares, 1 << kMostReferences> all{};
  for (unsigned mask = 1; mask < all.size(); ++mask) {
    int count = 0;
    for (unsigned rest = mask; rest != 0; rest >>= 1) count += static_cast<int>(rest & 1);
    int share = kShare - (count - 1) * (kShare / count);  // share of the first reference
    for (int reference = 0; reference < kMostReferences; ++reference) {
      if ((mask >> reference & 1) == 0) continue;
      all[mask][reference] = static_cast<uint8_t>(share);
      share = kShare / count;
    }
  }
  return all;
}
inline constexpr std::array<Shares, 1 << kMostReferences> kSharesOfMask = MakeShares();

// One reference image at one depth in a cell.
struct CellTerm {
  int reference = 0;
  int depth = 0;
  // Shares in the blocks of the corners: upper left, upper right, lower left, lower right; 0 if a
  // block has another depth, or does not use the reference image.
  std::array<int, 4> shares{};
};

struct CellTerms {
  std::array<CellTerm, 4 * kMostReferences> terms;
  int count = 0;
};

// Cells are numbered from 0; cell i along an axis begins at pixel i * side - side / 2. Returns the
// terms of a cell. Blocks beyond the ends of the field are those at the ends.
CellTerms TermsOfCell(const BlockField& blocks, int cell_x, int cell_y);

// Returns the part of a cell of the given side in which the weight of a term is not 0, relative to
// the cell.
PixelRect ReachOf(const CellTerm& term, int side);

PixelRect Moved(const PixelRect& rect, int x, int y);

// Displacements of the squares of a cell, in 1 / kPhases pixels.
struct CellMotion {
  int square = 0;  // side of a square, kLeastSquare to that of the cell
  std::array<std::array<WarpedPosition, kMostSquares>, kMostSquares> squares;  // [row][column]

  // Returns the displacement of the square that contains a pixel of the cell.
  const WarpedPosition& At(int x, int y) const { return squares[y / square][x / square]; }
};

// Finds the displacements of a cell whose first pixel is (x, y). The positions of its four corners
// are computed exactly (plane_warp.h), and displacements in between are interpolated. Squares are
// the largest for which these differ by at most 1/16 pixel from the displacement at the centre of
// the square, if displacements change evenly across the cell.
void SetMotion(const PlaneWarp& warp, int depth, int x, int y, int block_bits, CellMotion* motion);

}  // namespace lf
