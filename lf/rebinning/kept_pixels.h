// SPDX-License-Identifier: Apache-2.0
// LF pixels that are kept in memory, so that frames can be collected from them without the LF
// images (thesis 4.3.2: a sparse part of all rays). Each LF image keeps all pixels that frames ask
// for, or a random choice of them at edges (Eq. 4.4); pixels between kept ones are interpolated.
//
// If there are more pixels than may be kept, those with the largest hashes are dropped: a limit, at
// and above which hashes are dropped, is lowered by an eighth at a time. A pixel whose hash is
// below the limit was never dropped, so that the kept pixels depend only on which pixels were
// added, never on their order or the number of threads. Masks and depths cannot be dropped; beyond
// KeptPixels::kFreeBytes, they count as pixels, so that max_pixels bounds the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/light_field/model/lf_depths.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// The kept pixels of one LF image.
struct KeptImage {
  LfImageId id;
  int width_px = 0;  // of the whole LF image
  int height_px = 0;
  BayerPattern bayer = BayerPattern::kNone;     // LfPixels::bayer
  BayerPattern recorded = BayerPattern::kNone;  // LfPixels::recorded
  bool has_opacity = false;
  bool has_trust = false;
  // False: all unmasked pixels that frames ask for are kept. True: pixels that are not kept are
  // interpolated.
  bool is_sparse = false;
  PixelRect rect;                // bounds of the pixels that frames ask for; within the LF image
  std::vector<uint32_t> places;  // PlaceOf() of the kept pixels, ascending
  // [places.size()][value_count()]: the radiance of a mosaic's pixel, or R, G, B, then the opacity
  // and the trust if there are such
  std::vector<uint16_t> values;
  // Bits of the places of `rect` that are masked, 64 in each word, the first in the lowest bit;
  // empty: none is.
  std::vector<uint64_t> masked;
  LfDepths depths;  // LfPixels::depths

  size_t value_count() const {
    return (bayer == BayerPattern::kNone ? 3 : 1) + (has_opacity ? 1 : 0) + (has_trust ? 1 : 0);
  }
  size_t masked_words() const { return (static_cast<size_t>(rect.pixel_count()) + 63) / 64; }
  // Number of a pixel of `rect`, row by row from 0. An LF image has less than 2^32 pixels.
  uint32_t PlaceOf(int x, int y) const {
    return static_cast<uint32_t>(y - rect.y_begin) * static_cast<uint32_t>(rect.width()) +
           static_cast<uint32_t>(x - rect.x_begin);
  }
};

class KeptPixels {
 public:
  // The memory of LF images besides their pixels counts only beyond this number of bytes, ...
  static constexpr size_t kFreeBytes = size_t{8} << 20;
  // ... and then as so many bytes for each pixel: those of the smallest pixel, of a mosaic.
  static constexpr size_t kLeastPixelBytes = sizeof(uint32_t) + sizeof(uint16_t);
  // While pixels are dropped, LF images with this number of pixels, or with a sixteenth of all, are
  // copied together, before their old memory is free.
  static constexpr size_t kFewTogether = size_t{1} << 18;
  // Largest number of pixels that are interpolated together; more only where none of them is kept.
  static constexpr size_t kTilePixels = size_t{576} * 576;

  //   max_pixels  number of pixels that Add() leaves at most; at least 1
  explicit KeptPixels(size_t max_pixels, uint64_t limit = UINT64_MAX)
      : max_pixels_(max_pixels), limit_(limit) {}

  // Adds LF images, none of which may be there yet. Drops the pixels at and above the limit, and
  // lowers the limit until there are no more than max_pixels (is_too_small() tells if that fails).
  void Add(std::vector<KeptImage> images, ThreadPool& pool);

  // The LF images by ascending ids. One that was added stays, even if no pixel of it is kept.
  const std::map<LfImageId, KeptImage>& images() const { return images_; }
  size_t max_pixels() const { return max_pixels_; }
  // Exclusive upper bound of the hashes of all pixels; UINT64_MAX: no pixel was dropped.
  uint64_t limit() const { return limit_; }
  size_t size() const { return size_; }  // number of kept pixels
  size_t size_bytes() const;
  // Memory of masks, depths, and the entries of LF images, however few pixels are kept.
  size_t other_bytes() const { return other_bytes_; }
  // True if not even dropping all pixels makes room, because of other_bytes(). No pixel is kept.
  bool is_too_small() const { return size_ + OthersAsPixels() > max_pixels_; }

  // Hash of a pixel of an LF image; `number` is y * width_px + x in the whole LF image.
  static uint64_t HashOf(LfImageId id, uint64_t number);

  // Writes the pixels `rect` of an LF image, clipped to the LF image, to *pixels, whose memory it
  // reuses. Masks the pixels that are masked, those outside of KeptImage::rect and, unless
  // IsSparse(), those that are not kept. In a sparse LF image, the values of the others are
  // interpolated (fill_pixels.h). The LF image must have been added. Any thread may call it.
  void Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const;

  // True if pixels of the LF image that frames ask for may have been left out.
  bool IsSparse(const KeptImage& image) const { return image.is_sparse || limit_ != UINT64_MAX; }

 private:
  size_t Drop(uint64_t limit, KeptImage* image) const;
  void DropFromAll(ThreadPool& pool);
  size_t OthersAsPixels() const {
    if (other_bytes_ <= kFreeBytes) return 0;
    return (other_bytes_ - kFreeBytes + kLeastPixelBytes - 1) / kLeastPixelBytes;
  }

  size_t max_pixels_;
  uint64_t limit_;
  size_t size_ = 0;
  size_t other_bytes_ = 0;
  std::map<LfImageId, KeptImage> images_;
};

}  // namespace lf
