#include "lf/sequence/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lf/imageio/image_file.h"
#include "lf/sequence/display.h"

namespace lf {
namespace {

constexpr int kBorderPx = 4;
constexpr uint8_t kBorderGrey = 24;

// Source columns (or rows) under one target column, the last and first in part: [begin, end) and
// the share of each.
struct Cover {
  int begin = 0;
  std::vector<float> shares;  // sum 1
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

// Area average, in linear light: a mean of sRGB values would be too dark.
Image<uint8_t> Reduced(const Image<uint8_t>& picture, int width, int height) {
  static const Display8 display8;
  std::array<float, 256> linear;
  for (int i = 0; i < 256; ++i) linear[i] = static_cast<float>(LinearFromDisplay(i / 255.0));

  const std::vector<Cover> columns = Covers(picture.width(), width);
  const std::vector<Cover> rows = Covers(picture.height(), height);
  Image<uint8_t> reduced(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        for (size_t j = 0; j < rows[y].shares.size(); ++j)
          for (size_t i = 0; i < columns[x].shares.size(); ++i)
            sum += rows[y].shares[j] * columns[x].shares[i] *
                   linear[picture.at(columns[x].begin + static_cast<int>(i),
                                     rows[y].begin + static_cast<int>(j), c)];
        reduced.at(x, y, c) = display8(sum);
      }
  return reduced;
}

// The grid and the size of a picture in it.
struct SheetLayout {
  int columns = 1;
  int rows = 1;
  int width = 1;
  int height = 1;
};

// About as many columns as rows, so that the page has the shape of a frame.
SheetLayout LayOut(int count, int width, int height, int max_width_px) {
  SheetLayout layout;
  layout.columns = static_cast<int>(std::ceil(std::sqrt(count)));
  layout.rows = (count + layout.columns - 1) / layout.columns;
  const int room = (max_width_px - kBorderPx * (layout.columns + 1)) / layout.columns;
  layout.width = std::clamp(room, 1, width);
  layout.height = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(height) * layout.width / width)));
  return layout;
}

}  // namespace

std::vector<size_t> ContactSheetFrames(size_t frame_count, size_t limit) {
  const size_t count = std::min(frame_count, limit);
  std::vector<size_t> frames;
  for (size_t i = 0; i < count; ++i)
    frames.push_back(count == 1 ? 0 : (i * (frame_count - 1) + (count - 1) / 2) / (count - 1));
  return frames;
}

Result<void> WriteContactSheet(const std::filesystem::path& path,
                               const std::vector<Image<uint8_t>>& pictures, int max_width_px) {
  if (pictures.empty() || pictures[0].empty())
    return OutputError(fmt::format("{}: there is no frame to show on it", path.string()));
  const SheetLayout layout = LayOut(static_cast<int>(pictures.size()), pictures[0].width(),
                                    pictures[0].height(), max_width_px);
  Image<uint8_t> sheet(layout.columns * (layout.width + kBorderPx) + kBorderPx,
                       layout.rows * (layout.height + kBorderPx) + kBorderPx, 3, kBorderGrey);
  for (size_t i = 0; i < pictures.size(); ++i) {
    LF_CHECK(pictures[i].width() == pictures[0].width() && pictures[i].channels() == 3 &&
             pictures[i].height() == pictures[0].height());
    const Image<uint8_t> small = Reduced(pictures[i], layout.width, layout.height);
    const int column = static_cast<int>(i) % layout.columns;
    const int row = static_cast<int>(i) / layout.columns;
    for (int y = 0; y < layout.height; ++y)
      std::copy_n(small.row(y), 3 * static_cast<size_t>(layout.width),
                  &sheet.at(kBorderPx + column * (layout.width + kBorderPx),
                            kBorderPx + row * (layout.height + kBorderPx) + y));
  }
  return WriteImage(path, sheet.view());
}

}  // namespace lf
