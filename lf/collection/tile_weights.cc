// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/tile_weights.h"

#include <algorithm>
#include <cstring>

#include "lf/core/check.h"

namespace lf {
namespace {

// Writes the weights of the elements in row j of a block, like FeatheredWeight(). `above` and
// `below` are the feather at the two upper and the two lower corners of the block. From element to
// element, the weight changes by the same amount, so that additions suffice.
void FillFeathered(uint32_t weight, const uint16_t* above, const uint16_t* below, int j,
                   uint8_t (&weights)[kWeightBlock]) {
  constexpr int kOne = 2 * kWeightBlock;
  constexpr int kWhole = kWholeFeather * kOne * kOne;
  const int down = 2 * j + 1, full = static_cast<int>(weight), least = std::min(full, 1);
  const int left = above[0] * (kOne - down) + below[0] * down;
  const int right = above[1] * (kOne - down) + below[1] * down;
  int feathered = full * (kOne * left + (right - left)) + kWhole / 2;
  const int step = full * 2 * (right - left);
  for (int i = 0; i < kWeightBlock; ++i) {
    weights[i] = static_cast<uint8_t>(
        std::max(static_cast<int>(static_cast<uint32_t>(feathered) / kWhole), least));
    feathered += step;
  }
}

}  // namespace

void TileWeights::Fill(const RayWeights& weights, const PixelRect& tile, int pitch) {
  LF_CHECK(pitch >= tile.width());
  if (weights.are_same()) {
    LF_CHECK(weights.same() <= kMaxWeight);
    least_ = most_ = weights.same();
    return;
  }
  const WeightBlocks& blocks = weights.blocks();
  const int block_count =
      (blocks.EndX(tile.x_end - 1) - blocks.EndX(tile.x_begin)) / kWeightBlock + 1;
  of_blocks_.resize(static_cast<size_t>(block_count));
  is_feathered_ = !weights.FeatherIsWhole(tile);
  if (!is_feathered_ && HasOneWeight(weights, tile)) return;
  const size_t row_bytes = static_cast<size_t>(pitch);
  const size_t size = row_bytes * static_cast<size_t>(tile.height()) + 2 * kMargin;
  if (bytes_.size() < size) bytes_.resize(size);
  least_ = kMaxWeight;
  most_ = 0;
  above_.resize(of_blocks_.size() + 1);
  below_.resize(of_blocks_.size() + 1);
  // below_ is not filled yet. FillBlocks() knows this because below_y_ differs from the upper y of
  // the first row of blocks.
  below_y_ = blocks.EndY(tile.y_begin);
  uint8_t* row = bytes_.data() + kMargin;
  for (int y = tile.y_begin; y < tile.y_end;) {
    const bool any_feathered = FillBlocks(weights, tile, y);
    uint8_t* const first = row;
    FillRow(blocks, tile, first);
    const int begin = y, end = std::min(tile.y_end, blocks.EndY(y));
    for (row += row_bytes, ++y; y < end; ++y, row += row_bytes)
      std::memcpy(row, first, static_cast<size_t>(tile.width()));
    if (any_feathered)
      for (int of_block = begin; of_block < end; ++of_block)
        Feather(blocks, tile, of_block, first + static_cast<size_t>(of_block - begin) * row_bytes);
  }
}

// Returns true, and sets least_ and most_, if all blocks have the same weight.
bool TileWeights::HasOneWeight(const RayWeights& weights, const PixelRect& tile) {
  const WeightBlocks& blocks = weights.blocks();
  for (int y = tile.y_begin; y < tile.y_end; y = blocks.EndY(y)) {
    weights.OfRow(tile.x_begin, y, static_cast<int>(of_blocks_.size()), of_blocks_.data());
    if (y == tile.y_begin) least_ = of_blocks_[0];
    if (std::any_of(of_blocks_.begin(), of_blocks_.end(),
                    [this](uint8_t weight) { return weight != least_; }))
      return false;
  }
  most_ = least_;
  return true;
}

// Sets the weights and the feather of the row of blocks that contains row y of elements. Returns
// true if there are feathered blocks.
bool TileWeights::FillBlocks(const RayWeights& weights, const PixelRect& tile, int y) {
  const int count = static_cast<int>(of_blocks_.size());
  weights.OfRow(tile.x_begin, y, count, of_blocks_.data());
  const auto [least, most] = std::minmax_element(of_blocks_.begin(), of_blocks_.end());
  least_ = std::min<uint32_t>(least_, *least);
  most_ = std::max<uint32_t>(most_, *most);
  if (!is_feathered_) return false;
  const WeightBlocks& blocks = weights.blocks();
  const int begin_x = blocks.EndX(tile.x_begin) - kWeightBlock;
  const int begin_y = blocks.EndY(y) - kWeightBlock;
  if (below_y_ == begin_y)
    above_.swap(below_);
  else
    weights.FeatherOfRow(begin_x, begin_y, count + 1, above_.data());
  below_y_ = begin_y + kWeightBlock;
  weights.FeatherOfRow(begin_x, below_y_, count + 1, below_.data());
  feathered_.clear();
  uint32_t common = kWholeFeather;  // AND of all feathers; only the whole one has this bit
  for (size_t k = 0; k < of_blocks_.size(); ++k) {
    const uint32_t of_all = above_[k] & above_[k + 1] & below_[k] & below_[k + 1];
    common &= of_all;
    if (of_blocks_[k] == 0 || of_all == kWholeFeather) continue;
    if ((above_[k] | above_[k + 1] | below_[k] | below_[k + 1]) == 0)
      of_blocks_[k] = 1;  // the weight of all its elements: the least that FeatheredWeight() gives
    else
      feathered_.push_back(static_cast<int>(k));
  }
  if (common != kWholeFeather) least_ = 0;
  return !feathered_.empty();
}

// Writes the weights of one row of elements, without feather.
void TileWeights::FillRow(const WeightBlocks& blocks, const PixelRect& tile, uint8_t* row) const {
  int x = tile.x_begin;
  for (const uint8_t weight : of_blocks_) {
    const int end = std::min(tile.x_end, blocks.EndX(x));
    if (end - x == kWeightBlock)  // a constant size needs one store and no call
      std::memset(row + (x - tile.x_begin), weight, kWeightBlock);
    else
      std::memset(row + (x - tile.x_begin), weight, static_cast<size_t>(end - x));
    x = end;
  }
}

// Writes the weights of row y in the feathered blocks.
void TileWeights::Feather(const WeightBlocks& blocks, const PixelRect& tile, int y,
                          uint8_t* row) const {
  const int j = y - (blocks.EndY(y) - kWeightBlock);
  const int first_x = blocks.EndX(tile.x_begin) - kWeightBlock;
  for (const int k : feathered_) {
    uint8_t of_block[kWeightBlock];
    FillFeathered(of_blocks_[static_cast<size_t>(k)], &above_[static_cast<size_t>(k)],
                  &below_[static_cast<size_t>(k)], j, of_block);
    const int x = first_x + k * kWeightBlock;
    const int begin = std::max(tile.x_begin, x), end = std::min(tile.x_end, x + kWeightBlock);
    uint8_t* const to = row + (begin - tile.x_begin);
    if (end - begin == kWeightBlock)  // a constant size needs one store and no call
      std::memcpy(to, of_block, kWeightBlock);
    else
      std::memcpy(to, of_block + (begin - x), static_cast<size_t>(end - begin));
  }
}

}  // namespace lf
