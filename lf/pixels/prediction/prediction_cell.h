// SPDX-License-Identifier: Apache-2.0
// The cells between the centres of blocks, and which pixels of reference images each of them needs
// (predict.h). Internal to this folder.
#pragma once

#include <array>
#include <cstdint>

#include "lf/pixels/prediction/predict.h"

namespace lf {

// Pixels of a cell move in squares of 4 x 4: all pixels of a square have the same displacement.
inline constexpr int kSquareBits = 2;
inline constexpr int kSquare = 1 << kSquareBits;
inline constexpr int kMostSquares = 1 << (kMostBlockBits - kSquareBits);  // along a cell

// Displacements have kPhaseBits fraction bits. The interpolation at a position uses kTaps pixels
// along each axis, kTapsBefore of which lie before it.
inline constexpr int kPhaseBits = 6;
inline constexpr int kPhases = 1 << kPhaseBits;
inline constexpr int kTaps = 4;
inline constexpr int kTapsBefore = 1;

// Weights of the interpolation for each phase, in 1 / 2^kTapBits; their sum is 1. They are those of
// Catmull and Rom, rounded, halves up; the second one makes the sum exact.
inline constexpr int kTapBits = 7;
using Taps = std::array<int16_t, kTaps>;
constexpr std::array<Taps, kPhases> MakeTaps() {
  std::array<Taps, kPhases> all{};
  for (int p = 0; p < kPhases; ++p) {
    // With t = p / 64: 64 (-t^3 + 2 t^2 - t), 64 (-3 t^3 + 4 t^2 + t) and 64 (t^3 - t^2).
    const auto rounded = [](int numerator) { return (numerator + 2048) >> 12; };
    Taps& taps = all[p];
    taps[0] = static_cast<int16_t>(rounded(-p * p * p + 128 * p * p - 4096 * p));
    taps[2] = static_cast<int16_t>(rounded(-3 * p * p * p + 256 * p * p + 4096 * p));
    taps[3] = static_cast<int16_t>(rounded(p * p * p - 64 * p * p));
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

// Returns the weight of the right of two blocks at the column `offset` of a cell; that of the left
// block is kWindow less. Rows are weighted in the same way.
inline int WindowOfNext(int offset, int block_bits) { return (2 * offset + 1) * 16 >> block_bits; }

// Returns the share of a reference image in the mean of `count` of them.
//   rank  its rank among them
inline int ShareOf(int count, int rank) {
  return count == 3 ? (rank == 0 ? 6 : 5) : kShare / count;
}

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

// Displacements of the squares of a cell, in 1 / kPhases pixels.
struct CellMotion {
  bool is_uniform = false;  // all squares have the displacement of the first one
  std::array<std::array<WarpedPosition, kMostSquares>, kMostSquares> squares;  // [row][column]
};

// Finds the displacements of a cell whose first pixel is (x, y). The positions of its four corners
// are computed exactly (plane_warp.h), and displacements in between are interpolated. If the motion
// is uniform, only the first square is set.
void SetMotion(const PlaneWarp& warp, int depth, int x, int y, int block_bits, CellMotion* motion);

}  // namespace lf
