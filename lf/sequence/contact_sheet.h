// Up to a dozen frames, spread evenly over the sequence, on one page.
#pragma once

#include <filesystem>
#include <vector>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Which of `frame_count` frames a contact sheet shows: at most `limit` indices, first and last
// among them.
std::vector<size_t> ContactSheetFrames(size_t frame_count, size_t limit = 12);

// A grid of pictures of one size with thin borders, about as many columns as rows.
class ContactSheet {
 public:
  // For `count` pictures of width x height px, at least one; the page is at most max_width_px wide.
  ContactSheet(size_t count, int width, int height, int max_width_px = 1920);

  // Puts an 8-bit sRGB picture [height][width][3] at the i-th place, reduced to what there is room
  // for (area average in linear light). Threads may place different pictures at once.
  void Place(size_t i, const Image<uint8_t>& picture);

  // As PNG, atomically. kOutput: the folder, the disk.
  Result<void> Write(const std::filesystem::path& path) const;

 private:
  int width_;  // of the pictures
  int height_;
  int columns_;
  int reduced_width_;
  int reduced_height_;
  Image<uint8_t> page_;
};

}  // namespace lf
