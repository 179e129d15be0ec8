// SPDX-License-Identifier: Apache-2.0
// Contact sheet: up to a dozen frames, spread evenly over the sequence, on one page.
#pragma once

#include <filesystem>
#include <vector>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Returns the indices (from 0, ascending) of the frames that a contact sheet shows: at most `limit`
// of `frame_count`. The first and the last are included if `limit` is at least 2.
std::vector<size_t> ContactSheetFrames(size_t frame_count, size_t limit = 12);

// A grid of pictures of one size with thin borders, and with about as many columns as rows.
class ContactSheet {
 public:
  // Makes an empty page for `count` pictures (at least one) of width x height px. The page is at
  // most max_width_px wide.
  ContactSheet(size_t count, int width, int height, int max_width_px = 1920);

  // Puts an 8-bit sRGB picture [height][width][3], of the size given to the constructor, into cell
  // i of the grid, counted row by row, reduced to the size of the cell (area average in linear
  // light). Threads may place different pictures at the same time.
  void Place(size_t i, const Image<uint8_t>& picture);

  // Writes the page as PNG, atomically. kOutput: the folder or the disk cannot be written.
  Result<void> Write(const std::filesystem::path& path) const;

 private:
  int width_;  // size of the pictures before they are reduced, in pixels
  int height_;
  int columns_;
  int reduced_width_;
  int reduced_height_;
  Image<uint8_t> page_;
};

}  // namespace lf
