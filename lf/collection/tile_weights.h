// SPDX-License-Identifier: Apache-2.0
// The weights of one LF image's rays in one tile, one byte per element. A weight has the same index
// as the sums of its element (TileSums). Internal to collection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/core/geometry.h"

namespace lf {

class TileWeights {
 public:
  // Number of bytes before the weights, and behind them, which vectors may read although they
  // belong to no element.
  static constexpr size_t kMargin = 64;

  // Sets least() and most() for the elements of `rays`. If they differ, also writes the weights of
  // these elements to data().
  //   rays   part of the tile that contains all rays; must not be empty
  //   pitch  bytes from one row of elements to the next; at least the width of the tile plus
  //          kWeightBlock
  void Fill(const RayWeights& weights, const PixelRect& rays, const PixelRect& tile, int pitch);

  // Bounds of the weights of the rays. If both are equal, all weights are the same.
  uint32_t least() const { return least_; }
  uint32_t most() const { return most_; }

  // The weight of element (x, y) is at [y * pitch + x], counted from the corner of the tile. Must
  // not be read if least() and most() are equal.
  const uint8_t* data() const { return bytes_.data() + kMargin; }

 private:
  uint32_t least_ = 0;
  uint32_t most_ = 0;
  std::vector<uint8_t> bytes_;
  std::vector<uint8_t> of_blocks_;  // [row][column]: weight of each block without feather
  std::vector<uint16_t> corners_;   // [row][column]: feather at the corners of the blocks
};

// A row of blocks, from left to right.
struct RowOfBlocks {
  std::span<uint8_t> weights;  // without feather, one for each block
  // Feather at the upper and at the lower corners of the blocks, [weights.size() + 1]; null if the
  // feather is whole.
  const uint16_t* above = nullptr;
  const uint16_t* below = nullptr;
};

// Writes the weights of rows [j_begin, j_end) of elements of a row of blocks. The weight of column
// x in row j is written to to[(j - j_begin) * pitch + x], where column 0 is the first column of the
// first block. There are two functions, which a test compares: FillBlocksReference() calls
// FeatheredWeight() for every element, and FillBlocks() works on vectors.
//   blocks  FillBlocks() may change the weights of its blocks
//   pitch   if it is less than the width of all blocks, the bytes that belong to two rows get any
//           values
void FillBlocksReference(const RowOfBlocks& blocks, int j_begin, int j_end, ptrdiff_t pitch,
                         uint8_t* to);
void FillBlocks(const RowOfBlocks& blocks, int j_begin, int j_end, ptrdiff_t pitch, uint8_t* to);

}  // namespace lf
