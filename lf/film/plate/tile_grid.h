// SPDX-License-Identifier: Apache-2.0
// A plate cut into tiles: rectangles, to each of which one thread at a time adds rays.
#pragma once

#include <algorithm>
#include <cstddef>

#include "lf/core/geometry.h"

namespace lf {

// An element of a plate, by its column and row.
struct PlateElement {
  int x = 0;
  int y = 0;
  friend bool operator==(const PlateElement&, const PlateElement&) = default;
};

// Tiles are numbered row by row. Tiles at the right and lower border may be smaller.
struct TileGrid {
  int plate_width = 0;
  int plate_height = 0;
  int tile_width = 1;
  int tile_height = 1;

  int columns() const { return (plate_width + tile_width - 1) / tile_width; }
  int rows() const { return (plate_height + tile_height - 1) / tile_height; }
  size_t tile_count() const { return static_cast<size_t>(columns()) * rows(); }
  PixelRect RectOf(size_t tile) const {
    const int x = static_cast<int>(tile) % columns() * tile_width;
    const int y = static_cast<int>(tile) / columns() * tile_height;
    return {x, y, std::min(plate_width, x + tile_width), std::min(plate_height, y + tile_height)};
  }
  friend bool operator==(const TileGrid&, const TileGrid&) = default;
};

}  // namespace lf
