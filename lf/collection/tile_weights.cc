// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/tile_weights.h"

#include <algorithm>

#include "lf/core/check.h"

namespace lf {

void TileWeights::Fill(const RayWeights& weights, const PixelRect& rays, const PixelRect& tile,
                       int pitch) {
  LF_CHECK(pitch >= tile.width() + kWeightBlock && !rays.empty() &&
           Intersection(rays, tile) == rays);
  if (weights.are_same()) {
    LF_CHECK(weights.same() <= kMaxWeight);
    least_ = most_ = weights.same();
    return;
  }
  const WeightBlocks& blocks = weights.blocks();
  const int x_begin = blocks.EndX(rays.x_begin) - kWeightBlock;
  const int y_begin = blocks.EndY(rays.y_begin) - kWeightBlock;
  const int columns = (rays.x_end - x_begin + kWeightBlock - 1) / kWeightBlock;
  const int rows = (rays.y_end - y_begin + kWeightBlock - 1) / kWeightBlock;
  const auto row_of_blocks = [columns](int row) { return static_cast<size_t>(row) * columns; };
  of_blocks_.resize(row_of_blocks(rows));
  for (int row = 0; row < rows; ++row)
    weights.OfRow(rays.x_begin, y_begin + row * kWeightBlock, columns,
                  of_blocks_.data() + row_of_blocks(row));
  // Compilers vectorize this loop, but not std::minmax_element() or std::all_of().
  uint8_t least = kMaxWeight, most = 0;
  for (const uint8_t weight : of_blocks_) {
    least = std::min(least, weight);
    most = std::max(most, weight);
  }
  least_ = least;
  most_ = most;
  const int corner_columns = columns + 1;
  bool is_whole = weights.FeatherIsWhole(rays);
  if (!is_whole) {
    corners_.resize(static_cast<size_t>(corner_columns) * (rows + 1));
    weights.FeatherOfCorners(x_begin, y_begin, corner_columns, rows + 1, corners_.data());
    uint16_t common = kWholeFeather;  // the only feather with this bit
    for (const uint16_t feather : corners_) common &= feather;
    is_whole = common == kWholeFeather;
  }
  if (!is_whole) least_ = 0;
  if (least_ == most_) return;
  const size_t row_bytes = static_cast<size_t>(pitch);
  const size_t size = row_bytes * static_cast<size_t>(tile.height()) + 2 * kMargin;
  if (bytes_.size() < size) bytes_.resize(size);
  // Blocks may extend beyond `rays` by up to seven elements. To the right of the tile, and to the
  // left of the next row, there is room for them.
  for (int row = 0; row < rows; ++row) {
    const int y = y_begin + row * kWeightBlock;
    const int begin = std::max(y, rays.y_begin), end = std::min(y + kWeightBlock, rays.y_end);
    const uint16_t* const above =
        is_whole ? nullptr : corners_.data() + static_cast<size_t>(row) * corner_columns;
    FillBlocks({std::span(of_blocks_).subspan(row_of_blocks(row), static_cast<size_t>(columns)),
                above, is_whole ? nullptr : above + corner_columns},
               begin - y, end - y, pitch,
               bytes_.data() + kMargin + static_cast<size_t>(begin - tile.y_begin) * row_bytes +
                   x_begin - tile.x_begin);
  }
}

void FillBlocksReference(const RowOfBlocks& blocks, int j_begin, int j_end, ptrdiff_t pitch,
                         uint8_t* to) {
  const uint16_t whole[] = {kWholeFeather, kWholeFeather};
  for (int j = j_begin; j < j_end; ++j)
    for (size_t k = 0; k < blocks.weights.size(); ++k)
      for (int i = 0; i < kWeightBlock; ++i)
        to[(j - j_begin) * pitch + static_cast<ptrdiff_t>(k) * kWeightBlock + i] =
            static_cast<uint8_t>(FeatheredWeight(blocks.weights[k],
                                                 blocks.above ? blocks.above + k : whole,
                                                 blocks.below ? blocks.below + k : whole, i, j));
}

}  // namespace lf
