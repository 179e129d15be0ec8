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
  const WeightBlocks& blocks = weights.blocks();
  const int block_count =
      (blocks.EndX(tile.x_end - 1) - blocks.EndX(tile.x_begin)) / kWeightBlock + 1;
  of_blocks_.resize(static_cast<size_t>(block_count));
  above_.resize(of_blocks_.size() + 1);
  below_.resize(of_blocks_.size() + 1);
  // below_ is not filled yet. FillBlocks() knows this because below_y_ differs from the upper y of
  // the first row of blocks.
  below_y_ = blocks.EndY(tile.y_begin);
  uint8_t* row = bytes_.data() + kMargin;
  for (int y = tile.y_begin; y < tile.y_end;) {
    const bool rows_differ = FillBlocks(weights, tile, y);
    uint8_t* const first = row;
    FillRow(weights, tile, y, first);
    const int end = std::min(tile.y_end, blocks.EndY(y));
    row += row_bytes;
    for (++y; y < end; ++y, row += row_bytes) {
      if (rows_differ)
        FillRow(weights, tile, y, row);
      else
        std::memcpy(row, first, static_cast<size_t>(tile.width()));
    }
  }
}

// Sets the weights and the feather of the row of blocks that contains row y of elements. Returns
// true if the feather of some corner is not whole.
bool TileWeights::FillBlocks(const RayWeights& weights, const PixelRect& tile, int y) {
  const int count = static_cast<int>(of_blocks_.size());
  weights.OfRow(tile.x_begin, y, count, of_blocks_.data());
  const auto [least, most] = std::minmax_element(of_blocks_.begin(), of_blocks_.end());
  least_ = std::min<uint32_t>(least_, *least);
  most_ = std::max<uint32_t>(most_, *most);
  if (!weights.has_feather()) return false;
  const WeightBlocks& blocks = weights.blocks();
  const int begin_x = blocks.EndX(tile.x_begin) - kWeightBlock;
  const int begin_y = blocks.EndY(y) - kWeightBlock;
  if (below_y_ == begin_y)
    above_.swap(below_);
  else
    weights.FeatherOfRow(begin_x, begin_y, count + 1, above_.data());
  below_y_ = begin_y + kWeightBlock;
  weights.FeatherOfRow(begin_x, below_y_, count + 1, below_.data());
  const auto is_less = [](uint16_t feather) { return feather < kWholeFeather; };
  const bool is_feathered = std::any_of(above_.begin(), above_.end(), is_less) ||
                            std::any_of(below_.begin(), below_.end(), is_less);
  if (is_feathered) least_ = 0;
  return is_feathered;
}

void TileWeights::FillRow(const RayWeights& weights, const PixelRect& tile, int y,
                          uint8_t* row) const {
  const WeightBlocks& blocks = weights.blocks();
  const int j = y - (blocks.EndY(y) - kWeightBlock);
  int x = tile.x_begin;
  for (size_t k = 0; k < of_blocks_.size(); ++k) {
    const int block_end = blocks.EndX(x), end = std::min(tile.x_end, block_end);
    const uint32_t weight = of_blocks_[k];
    const uint32_t corners = above_[k] & above_[k + 1] & below_[k] & below_[k + 1];
    if (!weights.has_feather() || weight == 0 || corners == kWholeFeather) {
      std::memset(row + (x - tile.x_begin), static_cast<int>(weight), static_cast<size_t>(end - x));
      x = end;
    }
    for (; x < end; ++x)
      row[x - tile.x_begin] = static_cast<uint8_t>(
          FeatheredWeight(weight, &above_[k], &below_[k], x - (block_end - kWeightBlock), j));
  }
}

}  // namespace lf
