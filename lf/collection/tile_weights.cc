#include "lf/collection/tile_weights.h"

#include <algorithm>
#include <cstring>

#include "lf/core/check.h"

namespace lf {

void TileWeights::Fill(const RayWeights& weights, const PixelRect& tile, int pitch) {
  LF_CHECK(pitch >= tile.width());
  if (weights.are_same()) {
    LF_CHECK(weights.same() <= kMaxWeight);
    least_ = most_ = weights.same();
    return;
  }
  const size_t row_bytes = static_cast<size_t>(pitch);
  const size_t size = row_bytes * static_cast<size_t>(tile.height()) + 2 * kMargin;
  if (bytes_.size() < size) bytes_.resize(size);
  least_ = kMaxWeight;
  most_ = 0;
  uint8_t* row = bytes_.data() + kMargin;
  const WeightBlocks& blocks = weights.blocks();
  const int block_count =
      (blocks.EndX(tile.x_end - 1) - blocks.EndX(tile.x_begin)) / kWeightBlock + 1;
  of_blocks_.resize(static_cast<size_t>(block_count));
  for (int y = tile.y_begin; y < tile.y_end;) {
    uint8_t* const first = row;
    weights.OfRow(tile.x_begin, y, block_count, of_blocks_.data());
    int x = tile.x_begin;
    for (const uint8_t weight : of_blocks_) {
      least_ = std::min<uint32_t>(least_, weight);
      most_ = std::max<uint32_t>(most_, weight);
      const int end = std::min(tile.x_end, blocks.EndX(x));
      std::memset(first + (x - tile.x_begin), weight, static_cast<size_t>(end - x));
      x = end;
    }
    const int end = std::min(tile.y_end, blocks.EndY(y));
    row += row_bytes;
    for (++y; y < end; ++y, row += row_bytes)
      std::memcpy(row, first, static_cast<size_t>(tile.width()));
  }
}

}  // namespace lf
