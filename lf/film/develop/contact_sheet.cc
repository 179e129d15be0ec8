// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/film/develop/display.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {

constexpr int kBorderPx = 4;
constexpr uint8_t kBorderGrey = 24;

// The columns (or rows) of a picture that are averaged into one column (or row) of the reduced
// picture, from `begin` on, and the share of each in the average. The first and the last of them
// may be covered only in part.
struct Cover {
  int begin = 0;
  std::vector<float> shares;  // their sum is 1
};

std::vector<Cover> Covers(int source_size, int target_size) {
  std::vector<Cover> covers(target_size);
  const double step = static_cast<double>(source_size) / target_size;
  for (int i = 0; i < target_size; ++i) {
    const double from = i * step, to = std::min<double>((i + 1) * step, source_size);
    covers[i].begin = static_cast<int>(from);
    for (int s = covers[i].begin; s < to; ++s)
      covers[i].shares.push_back(
          static_cast<float>((std::min<double>(s + 1, to) - std::max<double>(s, from)) / step));
  }
  return covers;
}

// Returns the picture reduced to width x height by area average in linear light, because a mean of
// sRGB values would be too dark.
Image<uint8_t> Reduced(const Image<uint8_t>& picture, int width, int height) {
  static const Display8 display8;
  std::array<float, 256> linear;
  for (int i = 0; i < 256; ++i) linear[i] = static_cast<float>(LinearFromDisplay(i / 255.0));

  const std::vector<Cover> columns = Covers(picture.width(), width);
  const std::vector<Cover> rows = Covers(picture.height(), height);
  Image<uint8_t> reduced(width, height, 3);
  // Weighted mean, in linear light, of the rows that become one row of the reduced picture.
  std::vector<float> row(3 * static_cast<size_t>(picture.width()));
  for (int y = 0; y < height; ++y) {
    std::fill(row.begin(), row.end(), 0.0f);
    for (size_t j = 0; j < rows[y].shares.size(); ++j) {
      const uint8_t* source = picture.row(rows[y].begin + static_cast<int>(j));
      for (size_t i = 0; i < row.size(); ++i) row[i] += rows[y].shares[j] * linear[source[i]];
    }
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        for (size_t i = 0; i < columns[x].shares.size(); ++i)
          sum += columns[x].shares[i] * row[3 * (static_cast<size_t>(columns[x].begin) + i) + c];
        reduced.at(x, y, c) = display8(sum);
      }
  }
  return reduced;
}

}  // namespace

std::vector<size_t> ContactSheetFrames(size_t frame_count, size_t limit) {
  const size_t count = std::min(frame_count, limit);
  std::vector<size_t> frames;
  for (size_t i = 0; i < count; ++i)
    frames.push_back(count == 1 ? 0 : (i * (frame_count - 1) + (count - 1) / 2) / (count - 1));
  return frames;
}

ContactSheet::ContactSheet(size_t count, int width, int height, int max_width_px)
    : width_(width), height_(height) {
  LF_CHECK(count > 0 && width > 0 && height > 0);
  columns_ = static_cast<int>(std::ceil(std::sqrt(count)));
  const int rows = (static_cast<int>(count) + columns_ - 1) / columns_;
  const int room = (max_width_px - kBorderPx * (columns_ + 1)) / columns_;
  reduced_width_ = std::clamp(room, 1, width);
  reduced_height_ = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(height) * reduced_width_ / width)));
  page_ = Image<uint8_t>(columns_ * (reduced_width_ + kBorderPx) + kBorderPx,
                         rows * (reduced_height_ + kBorderPx) + kBorderPx, 3, kBorderGrey);
}

void ContactSheet::Place(size_t i, const Image<uint8_t>& picture) {
  LF_CHECK(picture.width() == width_ && picture.height() == height_ && picture.channels() == 3);
  const Image<uint8_t> reduced = Reduced(picture, reduced_width_, reduced_height_);
  const int column = static_cast<int>(i) % columns_;
  const int row = static_cast<int>(i) / columns_;
  for (int y = 0; y < reduced_height_; ++y)
    std::copy_n(reduced.row(y), 3 * static_cast<size_t>(reduced_width_),
                &page_.at(kBorderPx + column * (reduced_width_ + kBorderPx),
                          kBorderPx + row * (reduced_height_ + kBorderPx) + y));
}

Result<void> ContactSheet::Write(const std::filesystem::path& path) const {
  return WriteImage(path, page_.view());
}

}  // namespace lf
