// SPDX-License-Identifier: Apache-2.0
// The layout of a file of kept pixels (doc/formats/kept_pixels.md), for its writer and reader.
// Internal to rebinning.
#pragma once

#include <cstdint>
#include <string_view>

#include "lf/core/hash.h"
#include "lf/film/plate/entry_file.h"
#include "lf/rebinning/kept_pixels.h"

namespace lf::kept_pixels_format {

inline constexpr entry_file::Kind kKind = {"LFPIXEL\n", 1, "file of kept pixels",
                                           "the pixels in it cannot be used"};

// The file begins with this head. The text of the entries follows, then the hash of head and text,
// then the block of each LF image, by ascending ids.
struct FileHead {
  char magic[8];
  uint32_t version;
  uint32_t text_bytes;
  uint64_t limit;  // KeptPixels::limit()
  uint64_t image_count;
  uint64_t pixel_count;  // KeptPixels::size()
  uint64_t block_bytes;  // size of all blocks together
};
static_assert(sizeof(FileHead) == 48);

// The head of a block. KeptImage::masked, places, values, and the numbers of the depths follow, as
// they are in memory.
struct ImageHead {
  // Bits of `flags`
  static constexpr uint32_t kOpacity = 1;
  static constexpr uint32_t kTrust = 2;
  static constexpr uint32_t kSparse = 4;
  static constexpr uint32_t kAllFlags = 7;

  uint64_t hash;  // XXH3 of the rest of the head and all that follows in the block
  uint32_t id;
  uint32_t width_px;
  uint32_t height_px;
  uint32_t rect[4];  // x_begin, y_begin, x_end, y_end
  uint32_t mask_words;
  uint32_t pixel_count;
  uint32_t depth_width;  // of the numbers; 0 if no depth is known
  uint32_t depth_height;
  uint32_t depth_divisor;
  uint16_t bayer;
  uint16_t recorded;
  uint32_t flags;
  double depth_least;
  double depth_greatest;
};
static_assert(sizeof(ImageHead) == 80);

// Returns the number of values of each pixel, for any bytes of a head.
inline uint64_t ValueCount(const ImageHead& head) {
  return (head.bayer == 0 ? 3 : 1) + ((head.flags & ImageHead::kOpacity) != 0 ? 1 : 0) +
         ((head.flags & ImageHead::kTrust) != 0 ? 1 : 0);
}

template <class Values>
std::string_view BytesOf(const Values& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(*values.data())};
}

// Returns the hash of the head, except for the hash in it, and of the content of the LF image.
inline uint64_t HashOf(const ImageHead& head, const KeptImage& image) {
  Hasher hasher;
  hasher.Add(std::string_view(reinterpret_cast<const char*>(&head), sizeof(head))
                 .substr(sizeof(head.hash)));
  hasher.Add(BytesOf(image.masked));
  hasher.Add(BytesOf(image.places));
  hasher.Add(BytesOf(image.values));
  hasher.Add(BytesOf(image.depths.numbers.pixels()));
  return hasher.Hash();
}

}  // namespace lf::kept_pixels_format
