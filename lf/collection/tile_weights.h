// SPDX-License-Identifier: Apache-2.0
// The weights of one LF image's rays in one tile, one byte per element. A weight has the same index
// as the sums of its element (TileSums). Internal to collection.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/core/geometry.h"

namespace lf {

class TileWeights {
 public:
  // Number of bytes before the weights, and behind them, which vectors may read although they
  // belong to no element.
  static constexpr size_t kMargin = 64;

  // Sets least() and most() for a tile. If they differ, also writes the weights to data().
  //   pitch  bytes from one row of elements to the next
  void Fill(const RayWeights& weights, const PixelRect& tile, int pitch);

  // Bounds of the weights of the tile. If both are equal, all weights are the same.
  uint32_t least() const { return least_; }
  uint32_t most() const { return most_; }

  // The weight of element (x, y) is at [y * pitch + x], counted from the corner of the tile. Must
  // not be read if least() and most() are equal.
  const uint8_t* data() const { return bytes_.data() + kMargin; }

 private:
  bool HasOneWeight(const RayWeights& weights, const PixelRect& tile);
  bool FillBlocks(const RayWeights& weights, const PixelRect& tile, int y);
  void FillRow(const WeightBlocks& blocks, const PixelRect& tile, uint8_t* row) const;
  void Feather(const WeightBlocks& blocks, const PixelRect& tile, int y, uint8_t* row) const;

  uint32_t least_ = 0;
  uint32_t most_ = 0;
  std::vector<uint8_t> bytes_;
  // One row of blocks, which are 8 x 8 elements of equal weight (kWeightBlock): the weight of each
  // block, and the feather at the upper (above_) and the lower (below_) corners of the blocks.
  std::vector<uint8_t> of_blocks_;
  std::vector<uint16_t> above_;
  std::vector<uint16_t> below_;
  std::vector<int> feathered_;  // indices of blocks whose feather is neither whole nor 0
  int below_y_ = 0;             // y of the corners that below_ holds
  bool is_feathered_ = false;   // false: feather is whole, and above_ and below_ are not used
};

}  // namespace lf
