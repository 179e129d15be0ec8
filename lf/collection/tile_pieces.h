// SPDX-License-Identifier: Apache-2.0
// The pieces of segments that land in each tile of a plate. Kernels read them; other code only
// passes them on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/collection/segments.h"
#include "lf/film/plate/tile_grid.h"

namespace lf {

// Positions [begin, end) of the segment with the index `segment` in Cut(), counted from its first
// position. All of them land in one tile, if positions outside the plate are clamped to it. At most
// `crowd` of them land in the same element, not counting clamped positions.
struct TilePiece {
  uint32_t segment = 0;
  uint16_t begin = 0;
  uint16_t end = 0;
  uint16_t crowd = 0;
};

// The pieces of each tile, in the order of the segments.
class TilePieces {
 public:
  // Cuts segments at the borders of tiles. Computes positions in single precision, as kernels do.
  void Cut(const std::vector<Segment>& segments, const TileGrid& grid);

  const TilePiece* begin(size_t tile) const { return sorted_.data() + tile_begin_[tile]; }
  const TilePiece* end(size_t tile) const { return sorted_.data() + tile_begin_[tile + 1]; }

 private:
  std::vector<TilePiece> sorted_;
  std::vector<uint32_t> tile_begin_;  // [tile_count + 1]: index in sorted_ of a tile's first piece
};

}  // namespace lf
