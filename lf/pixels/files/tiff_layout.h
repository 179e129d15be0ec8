// SPDX-License-Identifier: Apache-2.0
// Describes how a TIFF file stores its first picture. Internal to this folder.
#pragma once

#include <tiffio.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/tiff_samples.h"

namespace lf {

// A picture is stored in blocks: strips of rows, or tiles. If is_separate is true, each channel is
// a plane with blocks of its own, which hold one sample per pixel.
struct TiffLayout {
  int width = 0;
  int height = 0;
  int samples = 0;  // number of samples per pixel, in the file
  TiffSamples type;
  bool is_inverted = false;      // true if 0 is white in the first sample; only up to 16 bits
  std::vector<uint8_t> palette;  // R, G, B for each index; empty: none
  int compression = COMPRESSION_NONE;
  bool is_separate = false;
  bool is_tiled = false;
  uint32_t block_width = 0;
  uint32_t block_height = 0;
  std::vector<std::string> channel_names;
  int orientation = 1;

  int channels() const { return palette.empty() ? samples : 3; }
  int samples_of_block() const { return is_separate ? 1 : samples; }
  int planes() const { return is_separate ? samples : 1; }
  uint32_t blocks_across() const { return Ceil(width, block_width); }
  uint32_t blocks_down() const { return Ceil(height, block_height); }
  // Returns the number of blocks of all planes.
  uint64_t block_count() const {
    return uint64_t{blocks_across()} * blocks_down() * static_cast<uint64_t>(planes());
  }
  // Returns the number of bytes of one row of a block.
  uint64_t row_bytes() const {
    return (uint64_t{block_width} * static_cast<uint64_t>(samples_of_block() * type.bits) + 7) / 8;
  }
  uint64_t block_bytes() const { return row_bytes() * block_height; }

 private:
  static uint32_t Ceil(int size, uint32_t block) {
    return static_cast<uint32_t>((static_cast<uint64_t>(size) + block - 1) / block);
  }
};

// Describes the picture of the current directory of `tiff`. kInput: the picture is damaged, larger
// than ReadImage() allows, or of a kind that is not read.
Result<TiffLayout> TiffLayoutOf(TIFF* tiff, const std::string& name);

}  // namespace lf
