// What a batch of LF images adds to one tile of a plate, before the plate sees it: small enough for
// the second level cache, and laid out so that the rays of neighbouring LF pixels fall on
// neighbouring words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/large_vector.h"
#include "lf/plate/sensor_plate.h"
#include "lf/plate/tile_grid.h"

namespace lf {

class TileSums {
 public:
  // Of RGB LF images: sums of 16-bit values and the number of rays.
  struct alignas(16) Element {
    uint32_t rgb_rays[4] = {};
  };

  // Of rays that count differently in each colour: sums of 16-bit values times counts, and the
  // counts. The fourth lanes are not flushed.
  struct alignas(16) CountedElement {
    uint32_t rgb[4] = {};
    uint32_t counts[4] = {};
  };

  // Of mosaics: packed words as the plate's. Along a scanline green alternates with another colour;
  // if an LF pixel is as large as an element, so it does along a row of elements. A row of elements
  // has one row of words for each of these, so that the scanline adds to words side by side:
  //   kRedFirst    R at even x, G at odd ones     kBlueFirst   B at even x, G at odd ones
  //   kGreenFirst  G at even x, R at odd ones     kGreenFirst + kBlueFirst   G, B
  static constexpr int kRedFirst = 0;
  static constexpr int kGreenFirst = 1;
  static constexpr int kBlueFirst = 2;
  static constexpr int kMosaicRows = 4;
  static constexpr int kMargin = 8;

  // Tiles of this shape stay in the second level cache while a batch of LF images is added to them.
  // The wider they are, the fewer pieces scanlines are cut into; tall enough for turned cameras.
  static constexpr int kTileWidth = 512;
  static constexpr int kTileHeight = 32;
  static TileGrid GridOf(int plate_width, int plate_height) {
    return {plate_width, plate_height, kTileWidth, kTileHeight};
  }

  // The brightest rays that a sum of 32 bits holds.
  static constexpr uint32_t kMaxRays = 65537;

  // ray_limit: below kMaxRays for tests only.
  explicit TileSums(uint32_t ray_limit = kMaxRays)
      : ray_limit_(ray_limit),
        mosaic_limit_(ray_limit == kMaxRays ? SensorPlate::kMaxCount : ray_limit) {}

  // The channels of the plate that sums of RGB LF images go to.
  enum class Target : uint8_t {
    kColours,  // R, G and B to theirs
    kOpacity,  // R to the fourth, for opacities that stand in for each colour
  };

  // Makes `tile` the owner of everything that is added from here on until Flush().
  //   watched  elements of the tile whose sums Added() tells; they must live until the last call of
  //            Added(). Without them nothing is kept beside the sums.
  //   target   kOpacity: of a plate that has it; RGB alone may be reserved, and nothing is watched
  void Begin(PlateTile* tile, std::span<const PlateElement> watched = {},
             Target target = Target::kColours);
  const PixelRect& rect() const { return tile_->rect(); }

  // Words or elements from one row to the next: a cache line more than they are wide, since columns
  // of a power of two would share a few lines of the first level cache.
  int stride() const { return rect().width() + 8; }

  // [height][stride()]. Afterwards `rays` more may be added to any element; rays <= max_reserve().
  Element* ReserveRgb(uint32_t rays) {
    if (rays > rgb_headroom_) MakeRgbRoom(rays);
    rgb_headroom_ -= rays;
    return elements_.data();
  }

  // [height][stride()], likewise.
  CountedElement* ReserveCounted(uint32_t rays) {
    if (rays > counted_headroom_) MakeCountedRoom(rays);
    counted_headroom_ -= rays;
    return counted_.data();
  }

  // [height][kMosaicRows][stride()], likewise. kMargin words before and behind the rows of the
  // tile may be added to as well, but only zeros.
  uint64_t* ReserveMosaic(uint32_t rays) {
    if (rays > mosaic_headroom_) MakeMosaicRoom(rays);
    mosaic_headroom_ -= rays;
    return words_.data() + kMargin;
  }

  uint32_t max_reserve() const { return ray_limit_; }

  // Adds everything to the plate; the sums are 0 again.
  void Flush();

  // Returns the sum and count that were added to a watched element since Begin(), exact, in
  // whichever of the three layouts and however often the sums were flushed meanwhile.
  //   index  of the element among those given to Begin()
  ElementSum Added(size_t index, int channel) const;

 private:
  void MakeRgbRoom(uint32_t rays);
  void MakeCountedRoom(uint32_t rays);
  void MakeMosaicRoom(uint32_t rays);
  void FlushRgb();
  template <class AddTo>
  void FlushRgbBy(const AddTo& add_to);
  void FlushCounted();
  void FlushMosaic();
  // Sums that are not flushed yet, one function for each layout; 0 where the layout is not in use.
  ElementSum PendingRgb(const PlateElement& element, int channel) const;
  ElementSum PendingCounted(const PlateElement& element, int channel) const;
  ElementSum PendingMosaic(const PlateElement& element, int channel) const;
  template <class Pending>
  void KeepWatched(const Pending& pending);

  uint32_t ray_limit_;
  uint32_t mosaic_limit_;  // what the plate's words hold
  PlateTile* tile_ = nullptr;
  Target target_ = Target::kColours;
  bool has_rgb_ = false;
  bool has_counted_ = false;
  bool has_mosaic_ = false;
  // Rays that still fit; 0 before there are sums.
  uint32_t rgb_headroom_ = 0;
  uint32_t counted_headroom_ = 0;
  uint32_t mosaic_headroom_ = 0;
  // All 0 but between the first Reserve and Flush().
  LargeVector<Element> elements_;
  LargeVector<CountedElement> counted_;
  LargeVector<uint64_t> words_;
  std::span<const PlateElement> watched_;
  std::vector<ElementSum> watched_flushed_;  // [watched][channel], since Begin()
};

}  // namespace lf
