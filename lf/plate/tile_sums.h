// What a batch of RGB LF images adds to one tile of a plate, before the plate sees it: small
// enough for the second level cache, and one 128-bit addition for a ray of three colours.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/plate/sensor_plate.h"

namespace lf {

class TileSums {
 public:
  // Sums of 16-bit values and the number of rays.
  struct alignas(16) Element {
    uint32_t rgb_rays[4] = {};
  };
  // Tiles of this shape stay in the second level cache while a batch of LF images is added to them.
  // The wider they are, the fewer pieces scanlines are cut into; tall enough for turned cameras.
  static constexpr int kTileWidth = 384;
  static constexpr int kTileHeight = 80;
  // The brightest rays that a sum of 32 bits holds.
  static constexpr uint32_t kMaxRays = 65537;

  // ray_limit: below kMaxRays for tests only.
  explicit TileSums(uint32_t ray_limit = kMaxRays) : ray_limit_(ray_limit) {}

  // What is added from here on, until Flush(), belongs to `tile`.
  void Begin(PlateTile* tile);
  PlateTile& tile() { return *tile_; }

  // [height][width] of the tile, rows stride() elements apart: one cache line more than they are
  // wide, since columns of a power of two would share a few lines of the first level cache.
  Element* elements() { return elements_.data(); }
  int stride() const { return tile_->rect().width() + 4; }

  // The most rays one Reserve() can be asked for.
  uint32_t max_reserve() const { return ray_limit_; }

  // Afterwards `rays` more may be added to any element. rays <= max_reserve().
  void Reserve(uint32_t rays) {
    if (rays > headroom_) MakeRoom(rays);
    headroom_ -= rays;
  }

  // Adds everything to the plate; the sums are 0 again.
  void Flush();

 private:
  void MakeRoom(uint32_t rays);

  uint32_t ray_limit_;
  uint32_t headroom_ = 0;
  PlateTile* tile_ = nullptr;
  std::vector<Element> elements_;
};

}  // namespace lf
