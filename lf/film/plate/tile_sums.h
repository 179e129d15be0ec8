// SPDX-License-Identifier: Apache-2.0
// Sums of the rays that a batch of LF images adds to one tile of a plate, kept here until they are
// added to the plate. They are small enough for the second level cache, and laid out so that the
// rays of neighbouring LF pixels fall on neighbouring words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/large_vector.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/film/plate/tile_grid.h"

namespace lf {

class TileSums {
 public:
  // Sums for RGB LF images: the sums of the 16-bit values R, G and B, then the number of rays.
  struct alignas(16) Element {
    uint32_t rgb_rays[4] = {};
  };

  // For mosaics: packed words like the words of the plate. Along a scanline, green alternates with
  // another colour. If an LF pixel is as large as an element, the colours alternate in the same way
  // along a row of elements. A row of elements has one row of words for each alternation, so that a
  // scanline adds to adjacent words (x counts from the left border of the tile):
  //   kRedFirst    R at even x, G at odd x    kBlueFirst                B at even x, G at odd x
  //   kGreenFirst  G at even x, R at odd x    kGreenFirst + kBlueFirst  G at even x, B at odd x
  static constexpr int kRedFirst = 0;
  static constexpr int kGreenFirst = 1;
  static constexpr int kBlueFirst = 2;
  static constexpr int kMosaicRows = 4;
  static constexpr int kMargin = 8;

  // Tiles of this shape stay in the second level cache while a batch of LF images is added to them.
  // They are wide, so that scanlines are cut into few pieces, and tall enough for turned cameras.
  static constexpr int kTileWidth = 512;
  static constexpr int kTileHeight = 32;
  static TileGrid GridOf(int plate_width, int plate_height) {
    return {plate_width, plate_height, kTileWidth, kTileHeight};
  }

  // Largest number of rays of value 65535 whose sum fits in 32 bits.
  static constexpr uint32_t kMaxRays = 65537;

  // ray_limit: number of rays after which sums are added to the plate; below kMaxRays for tests
  // only. If it is kMaxRays, sums of mosaics take SensorPlate::kMaxCount rays.
  explicit TileSums(uint32_t ray_limit = kMaxRays)
      : ray_limit_(ray_limit),
        mosaic_limit_(ray_limit == kMaxRays ? SensorPlate::kMaxCount : ray_limit) {}

  // The channels of the plate that sums go to: the sums of `count` colours, from the colour `first`
  // on (0 is R), are added to as many channels, from `channel` on.
  struct Target {
    int channel = 0;
    int first = 0;
    int count = SensorPlate::kChannels;
    friend bool operator==(const Target&, const Target&) = default;
  };

  // Makes `tile` the destination of everything that is added until Flush(). The sums of an earlier
  // tile must have been flushed.
  //   watched  elements of the tile whose sums Added() returns; must outlive the last call of
  //            Added() or Flush() for this tile
  //   target   must have channels of the plate; unless they are the first three, `watched` must be
  //            empty, and ReserveMosaic() must not be called
  void Begin(PlateTile* tile, std::span<const PlateElement> watched, const Target& target);
  void Begin(PlateTile* tile, std::span<const PlateElement> watched = {}) {
    Begin(tile, watched, Target());
  }
  const PixelRect& rect() const { return tile_->rect(); }

  // Number of words or elements from one row to the next. This is at least a cache line more than
  // the width, because columns at a distance of a power of two would share a few lines of the first
  // level cache.
  int stride() const { return rect().width() + 8; }

  // Returns the sums [height][stride()], to whose elements `rays` more rays may then be added, even
  // all to one element. `rays` is at most max_reserve().
  Element* ReserveRgb(uint32_t rays) {
    if (rays > rgb_headroom_) MakeRgbRoom(rays);
    rgb_headroom_ -= rays;
    return elements_.data();
  }

  // As ReserveRgb(), but returns packed words [height][kMosaicRows][stride()] for mosaics. Zeros
  // may be added to kMargin words in front of and behind the rows of the tile.
  uint64_t* ReserveMosaic(uint32_t rays) {
    if (rays > mosaic_headroom_) MakeMosaicRoom(rays);
    mosaic_headroom_ -= rays;
    return words_.data() + kMargin;
  }

  uint32_t max_reserve() const { return ray_limit_; }

  // Adds all sums to the plate and sets them to 0.
  void Flush();

  // Returns the exact sum and count that were added to a watched element since Begin(), over both
  // layouts (RGB and mosaic), however often the sums were flushed meanwhile.
  //   index  of the element among those given to Begin()
  ElementSum Added(size_t index, int channel) const;

 private:
  void MakeRgbRoom(uint32_t rays);
  void MakeMosaicRoom(uint32_t rays);
  void FlushRgb();
  bool HasThree() const { return target_.count == SensorPlate::kChannels; }
  template <class AddTo>
  void FlushRgbBy(const AddTo& add_to);
  void FlushMosaic();
  // Return the sums that are not flushed yet, one function for each layout; 0 if the layout is not
  // in use.
  ElementSum PendingRgb(const PlateElement& element, int channel) const;
  ElementSum PendingMosaic(const PlateElement& element, int channel) const;
  template <class Pending>
  void KeepWatched(const Pending& pending);

  uint32_t ray_limit_;
  uint32_t mosaic_limit_;  // largest number of rays in a packed word
  PlateTile* tile_ = nullptr;
  Target target_;
  bool has_rgb_ = false;
  bool has_mosaic_ = false;
  // Numbers of rays that may still be added before a flush; 0 if the layout is not in use.
  uint32_t rgb_headroom_ = 0;
  uint32_t mosaic_headroom_ = 0;
  // Sums of both layouts. They are 0, except between the first Reserve*() and Flush().
  LargeVector<Element> elements_;
  LargeVector<uint64_t> words_;
  std::span<const PlateElement> watched_;
  std::vector<ElementSum> watched_flushed_;  // [watched][channel] sums flushed since Begin()
};

}  // namespace lf
