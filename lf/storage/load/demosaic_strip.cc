// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/demosaic_strip.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "lf/storage/load/demosaic_rows.h"

namespace lf {
namespace {

// Squares that each step needs beyond the squares of the result. They are counted from the first
// and from the last square; the reach of each step is added to that of the step before it.
struct Margin {
  int before, after;
};
constexpr Margin kColourMargin = {1, 1};  // step 3, read by step 4; gains
constexpr Margin kDetailMargin = {kColourMargin.before + kWindowReach,
                                  kColourMargin.after + kWindowReach};
constexpr Margin kGreenMargin = {kDetailMargin.before, kDetailMargin.after + 1};
constexpr Margin kRootMargin = {kGreenMargin.before + 2, kGreenMargin.after + 2};

// Returns floor(value / 2).
constexpr int Half(int value) { return value >> 1; }

// Rows of one phase. The newest kRows rows are kept.
class RowRing {
 public:
  static constexpr int kRows = 8;
  RowRing() = default;
  RowRing(float* first, size_t stride) : first_(first), stride_(stride) {}
  float* Row(int y) const { return first_ + static_cast<size_t>(y & (kRows - 1)) * stride_; }

 private:
  float* first_ = nullptr;
  size_t stride_ = 0;
};

// Rows and columns of squares are counted from those of pixel (0, 0) of the LF image. An element of
// a row is the column of a square less first_.
class StripDemosaicker {
 public:
  StripDemosaicker(const WholeMosaic& mosaic, const BalancedLevels& levels, const PixelRect& strip,
                   StripMemory* memory, LfPixels* rgb)
      : mosaic_(mosaic),
        levels_(levels),
        strip_(strip),
        rgb_(rgb),
        bayer_(mosaic.pixels.bayer),
        square_count_(Half(strip.x_end + 1) - Half(strip.x_begin)),
        wide_count_(square_count_ + kRootMargin.before + kRootMargin.after),
        first_(Half(strip.x_begin) - kRootMargin.before) {
    for (int p = 0; p < 4; ++p) {
      const int channel = BayerChannel(bayer_, p & 1, p >> 1);
      if (channel != 1) site_x_[channel / 2] = p & 1, site_y_[channel / 2] = p >> 1;
    }
    Allot(memory);
  }

  void Run() {
    const int begin = Half(strip_.y_begin), end = Half(strip_.y_end + 1);
    for (int newest = begin - kRootMargin.before; newest < end + kRootMargin.after; ++newest) {
      MakeRoots(newest);
      const auto follow = [&](int lag, const Margin& margin, auto make) {
        const int row = newest - lag;
        if (row >= begin - margin.before && row < end + margin.after) (this->*make)(row);
      };
      // The row of green needs roots two rows below, the others one or two rows of the step before.
      follow(2, kGreenMargin, &StripDemosaicker::MakeGreen);
      follow(3, kDetailMargin, &StripDemosaicker::MakeDetails);
      follow(3 + kWindowReach, kColourMargin, &StripDemosaicker::MakeOpposites);
      follow(4 + kWindowReach, {0, 0}, &StripDemosaicker::MakePixels);
    }
  }

 private:
  static constexpr int kLanes = LfPixels::kRgbLanes;
  // In floats: each row begins at a multiple of a cache line (64 bytes), which is faster.
  static constexpr size_t kAlignment = 16;

  void Allot(StripMemory* memory) {
    const size_t stride =
        (static_cast<size_t>(wide_count_) + kAlignment - 1) / kAlignment * kAlignment;
    constexpr size_t kRings = 4 + 5 * 2, kSingle = 2 + 2;
    memory->values.resize((kRings * RowRing::kRows + kSingle) * stride);
    float* next = memory->values.data();
    const auto ring = [&](RowRing* rows) {
      *rows = RowRing(next, stride);
      next += RowRing::kRows * stride;
    };
    for (RowRing& rows : roots_) ring(&rows);
    for (auto* rings : {&green_, &products_, &squares_, &gains_, &opposite_})
      for (RowRing& rows : *rings) ring(&rows);
    for (float*& row : at_green_) row = next, next += stride;
    sums_ = next;
    mosaic_stride_ = 2 * static_cast<size_t>(wide_count_);
    memory->mosaic.resize(2 * RowRing::kRows * mosaic_stride_);
    mosaic_rows_ = memory->mosaic.data();
    memory->rgb.resize(2 * static_cast<size_t>(square_count_) * kLanes);
    rgb_row_ = memory->rgb.data();
  }

  // Returns the element of rows from which a step with this margin computes.
  static int First(const Margin& margin) { return kRootMargin.before - margin.before; }
  int CountOf(const Margin& margin) const { return square_count_ + margin.before + margin.after; }

  uint16_t* MosaicRow(int y) const {
    return mosaic_rows_ + static_cast<size_t>(y & (2 * RowRing::kRows - 1)) * mosaic_stride_;
  }
  // Returns pointers whose element k is the root (or green) of the pixel (x, y) relative to the
  // first pixel of the square in column k and in this row of squares.
  const float* Roots(int row, int x, int y) const {
    return roots_[2 * (y & 1) + (x & 1)].Row(row + Half(y)) + Half(x);
  }
  const float* Green(int row, int x, int y) const {
    const int channel = BayerChannel(bayer_, x, y);
    if (channel == 1) return Roots(row, x, y);
    return green_[channel / 2].Row(row + Half(y)) + Half(x);
  }
  // Returns R (c = 0) or B (c = 1), at a pixel that recorded R or B.
  const float* Colour(int c, int row, int x, int y) const {
    if (BayerChannel(bayer_, x, y) == 2 * c) return Roots(row, x, y);
    return opposite_[c].Row(row + Half(y)) + Half(x);
  }

  // Returns the value of a pixel of the LF image. A pixel that is not loaded has the value of one
  // beside it: no result depends on it.
  uint16_t PixelAt(int x, int y) const {
    const LfPixels& pixels = mosaic_.pixels;
    const int column = std::clamp(x, pixels.rect.x_begin, pixels.rect.x_end - 1);
    return pixels.any_masked &&
                   pixels.IsMasked(column - pixels.rect.x_begin, y - pixels.rect.y_begin)
               ? MeanAround(column, y)
               : pixels.radiance.at(column - pixels.rect.x_begin, y - pixels.rect.y_begin);
  }

  uint16_t MeanAround(int x, int y) const {
    const LfPixels& pixels = mosaic_.pixels;
    uint32_t sum = 0, count = 0;
    for (int dy = -2; dy <= 2; dy += 2)
      for (int dx = -2; dx <= 2; dx += 2) {
        const int column = Mirrored(x + dx, mosaic_.width) - pixels.rect.x_begin;
        const int row = Mirrored(y + dy, mosaic_.height) - pixels.rect.y_begin;
        if (column < 0 || column >= pixels.rect.width() || row < 0 || row >= pixels.rect.height() ||
            pixels.IsMasked(column, row))
          continue;
        sum += pixels.radiance.at(column, row);
        ++count;
      }
    if (count == 0) return pixels.radiance.at(x - pixels.rect.x_begin, y - pixels.rect.y_begin);
    return static_cast<uint16_t>((sum + count / 2) / count);
  }

  // Copies a row of the mosaic, mirrored at its ends.
  void FillMosaicRow(int y) {
    const LfPixels& pixels = mosaic_.pixels;
    const int from_y =
        std::clamp(Mirrored(y, mosaic_.height), pixels.rect.y_begin, pixels.rect.y_end - 1);
    const int x_begin = 2 * first_, x_end = x_begin + 2 * wide_count_;
    const int begin = std::max(x_begin, pixels.rect.x_begin);
    const int end = std::min(x_end, pixels.rect.x_end);
    uint16_t* const out = MosaicRow(y);
    std::memcpy(out + (begin - x_begin),
                pixels.radiance.row(from_y - pixels.rect.y_begin) + (begin - pixels.rect.x_begin),
                static_cast<size_t>(end - begin) * sizeof(*out));
    if (pixels.any_masked && !pixels.mosaic_mask.empty()) {
      const uint8_t* const kept = pixels.mosaic_mask.row(from_y - pixels.rect.y_begin);
      for (int x = begin; x < end; ++x)
        if (kept[x - pixels.rect.x_begin] == 0) out[x - x_begin] = MeanAround(x, from_y);
    }
    const auto fill_ends = [&](int from, int to) {
      for (int x = from; x < to; ++x)
        out[x - x_begin] = PixelAt(Mirrored(x, mosaic_.width), from_y);
    };
    fill_ends(x_begin, begin);
    fill_ends(end, x_end);
  }

  void MakeRoots(int row) {
    for (int y = 0; y < 2; ++y) {
      FillMosaicRow(2 * row + y);
      const auto factor = [&](int x) {
        return levels_.factor[static_cast<size_t>(BayerChannel(bayer_, x, y))];
      };
      RootRows(MosaicRow(2 * row + y), levels_.pedestal, {factor(0), factor(1)}, wide_count_,
               roots_[2 * y].Row(row), roots_[2 * y + 1].Row(row));
    }
  }

  void MakeGreen(int row) {
    const int first = First(kGreenMargin);
    for (int c = 0; c < 2; ++c) {
      const auto at = [&](int dx, int dy) {
        return Roots(row, site_x_[c] + dx, site_y_[c] + dy) + first;
      };
      GreenRow({at(0, 0),
                {at(-1, 0), at(-2, 0), at(-3, 0)},
                {at(1, 0), at(2, 0), at(3, 0)},
                {at(0, -1), at(0, -2), at(0, -3)},
                {at(0, 1), at(0, 2), at(0, 3)}},
               CountOf(kGreenMargin), green_[c].Row(row) + first);
    }
  }

  void MakeDetails(int row) {
    const int first = First(kDetailMargin);
    for (int c = 0; c < 2; ++c) {
      const RowRing& roots = roots_[2 * site_y_[c] + site_x_[c]];
      DetailRow({roots.Row(row) + first, roots.Row(row + 1) + first},
                {green_[c].Row(row) + first, green_[c].Row(row + 1) + first},
                CountOf(kDetailMargin), products_[c].Row(row) + first,
                squares_[c].Row(row) + first);
    }
  }

  // Computes gains, and with them the colours of step 3.
  void MakeOpposites(int row) {
    const int first = First(kColourMargin), count = CountOf(kColourMargin);
    for (int c = 0; c < 2; ++c) {
      std::array<const float*, 5> products, squares;
      for (int i = 0; i < 5; ++i) {
        products[i] = products_[c].Row(row + i - kWindowReach) + first;
        squares[i] = squares_[c].Row(row + i - kWindowReach) + first;
      }
      GainRow(products, squares, count, sums_, gains_[c].Row(row) + first);
      const int x = site_x_[1 - c], y = site_y_[1 - c];
      NeighbourRows near{};
      constexpr int kOffsets[4][2] = {{-1, -1}, {1, 1}, {1, -1}, {-1, 1}};
      for (int i = 0; i < 4; ++i) {
        near.colour[i] = Roots(row, x + kOffsets[i][0], y + kOffsets[i][1]) + first;
        near.green[i] = Green(row, x + kOffsets[i][0], y + kOffsets[i][1]) + first;
      }
      ColourRow(near, Green(row, x, y) + first, gains_[c].Row(row) + first, true, count,
                opposite_[c].Row(row) + first);
    }
  }

  // Computes R (c = 0) or B (c = 1) at the sites of G of a row of pixels (step 4).
  void MakeAtGreen(int row, int y, int c) {
    const int first = kRootMargin.before;
    const int x = BayerChannel(bayer_, 0, y) == 1 ? 0 : 1;
    const bool is_beside = BayerChannel(bayer_, x + 1, y) == 2 * c;
    constexpr int kBeside[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    NeighbourRows near{};
    for (int i = 0; i < 4; ++i) {
      const auto [dx, dy] = kBeside[is_beside ? i : (i + 2) % 4];
      near.colour[i] = Colour(c, row, x + dx, y + dy) + first;
      near.green[i] = Green(row, x + dx, y + dy) + first;
    }
    ColourRow(near, Green(row, x, y) + first, gains_[c].Row(row) + first, false, square_count_,
              at_green_[c]);
  }

  void MakePixels(int row) {
    for (int y = 0; y < 2; ++y) {
      const int image_y = 2 * row + y;
      if (image_y < strip_.y_begin || image_y >= strip_.y_end) continue;
      for (int c = 0; c < 2; ++c) MakeAtGreen(row, y, c);
      const int first = kRootMargin.before;
      const int c = site_y_[0] == y ? 0 : 1, x = site_x_[c];
      RgbRow({.c_is_red = c == 0,
              .c_is_even = x == 0,
              .mosaic = MosaicRow(image_y) + 2 * first,
              .g_at_c = Green(row, x, y) + first,
              .d_at_c = Colour(1 - c, row, x, y) + first,
              .c_at_g = at_green_[c],
              .d_at_g = at_green_[1 - c],
              .pedestal = levels_.pedestal,
              .inverse = levels_.inverse},
             square_count_, rgb_row_);
      std::memcpy(rgb_->radiance.row(image_y - rgb_->rect.y_begin) +
                      static_cast<ptrdiff_t>(strip_.x_begin - rgb_->rect.x_begin) * kLanes,
                  rgb_row_ + static_cast<ptrdiff_t>(strip_.x_begin & 1) * kLanes,
                  static_cast<size_t>(strip_.width()) * kLanes * sizeof(*rgb_row_));
    }
  }

  const WholeMosaic& mosaic_;
  const BalancedLevels& levels_;
  const PixelRect strip_;
  LfPixels* const rgb_;
  const BayerPattern bayer_;
  const int square_count_;  // number of squares of the result from left to right
  const int wide_count_;    // number of squares whose roots are computed
  const int first_;         // column of their first square
  // Parities of the columns and rows that recorded R and B.
  int site_x_[2] = {}, site_y_[2] = {};

  // Members with an index 0 or 1 hold R or B, or what is at sites of R or B.
  std::array<RowRing, 4> roots_;
  std::array<RowRing, 2> green_, products_, squares_, gains_, opposite_;
  std::array<float*, 2> at_green_{};
  float* sums_ = nullptr;
  size_t mosaic_stride_ = 0;
  uint16_t* mosaic_rows_ = nullptr;
  uint16_t* rgb_row_ = nullptr;
};

}  // namespace

void DemosaicStrip(const WholeMosaic& mosaic, const BalancedLevels& levels, const PixelRect& strip,
                   StripMemory* memory, LfPixels* rgb) {
  StripDemosaicker(mosaic, levels, strip, memory, rgb).Run();
}

}  // namespace lf
