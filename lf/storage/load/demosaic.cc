// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/demosaic.h"

#include <cstdint>
#include <cstring>
#include <vector>

#include "lf/core/check.h"
#include "lf/storage/load/demosaic_arithmetic.h"
#include "lf/storage/load/demosaic_row.h"

namespace lf {
namespace {

constexpr int kReach = 2;

// Five rows of the values of a mosaic or of its mask, with mirrored ends: all values from which one
// row of RGB pixels is computed.
template <class T>
class RowWindow {
 public:
  RowWindow(const Image<T>& mosaic, const PixelRect& mosaic_rect, int image_width, int image_height,
            const PixelRect& rect)
      : mosaic_(mosaic),
        mosaic_rect_(mosaic_rect),
        image_width_(image_width),
        image_height_(image_height),
        rect_(rect),
        next_row_(std::max(0, rect.y_begin - kReach)),
        stride_(static_cast<size_t>(rect.width()) + 2 * kMargin),
        values_(stride_ * kRows) {}

  // Returns pointers to rows y - 2 to y + 2, at column rect.x_begin. y must grow from call to call.
  std::array<const T*, 5> MoveTo(int y) {
    for (; next_row_ <= std::min(y + kReach, image_height_ - 1); ++next_row_) Fill(next_row_);
    std::array<const T*, 5> rows;
    for (int i = 0; i < kRows; ++i) rows[i] = Row(Mirrored(y + i - kReach, image_height_));
    return rows;
  }

 private:
  static constexpr int kRows = 2 * kReach + 1;
  // One column more than kReach is read, but not used, because a pair of mosaic pixels may begin
  // one column before the rectangle.
  static constexpr int kMargin = kReach + 1;

  T* Row(int y) { return values_.data() + static_cast<size_t>(y % kRows) * stride_ + kMargin; }

  void Fill(int y) {
    const T* const in = mosaic_.row(y - mosaic_rect_.y_begin);
    T* const out = Row(y);
    const auto copy = [&](int begin, int end) {
      for (int x = begin; x < end; ++x)
        out[x - rect_.x_begin] = in[Mirrored(x, image_width_) - mosaic_rect_.x_begin];
    };
    const int begin = std::max(0, rect_.x_begin - kReach);
    const int end = std::min(image_width_, rect_.x_end + kReach);
    copy(rect_.x_begin - kReach, begin);
    std::memcpy(out + (begin - rect_.x_begin), in + (begin - mosaic_rect_.x_begin),
                static_cast<size_t>(end - begin) * sizeof(T));
    copy(end, rect_.x_end + kReach);
  }

  const Image<T>& mosaic_;
  const PixelRect mosaic_rect_;
  const int image_width_, image_height_;
  const PixelRect rect_;
  int next_row_;
  size_t stride_;
  std::vector<T> values_;
};

RowGains GainsOf(const std::array<double, 3>& white_balance, int c) {
  constexpr int kGreen = 1;
  const int d = 2 - c;
  // DemosaicPairs() computes 4 L at a pixel of C and 10 L at a pixel of G, where L is the Laplacian
  // (demosaic.h). The factors are gain / 4 and gain / 10, in units of 1/16, times BalanceRatio().
  return {.g_at_c = 2 * BalanceRatio(white_balance, c, kGreen),  // gain 1/2
          .d_at_c = 3 * BalanceRatio(white_balance, c, d),       // gain 3/4
          .c_at_g = BalanceRatio(white_balance, kGreen, c),      // gain 5/8
          .d_at_g = BalanceRatio(white_balance, kGreen, d)};
}

// Computes the RGB pixels of a row.
//   rows  as RowWindow::MoveTo() returns them
void DemosaicRow(const std::array<const uint16_t*, 5>& rows, bool begins_with_g, bool c_is_red,
                 const RowGains& gains, int width, uint16_t* rgb) {
  constexpr int kLanes = LfPixels::kRgbLanes;
  const auto pairs_at = [&](int column, int count, uint16_t* out) {
    const uint16_t* at[5];
    for (size_t i = 0; i < rows.size(); ++i) at[i] = rows[i] + column;
    DemosaicPairs(at, c_is_red, gains, count, out);
  };
  uint16_t cut_pair[2 * kLanes];
  const int first = begins_with_g ? 1 : 0, pair_count = (width - first) / 2;
  if (begins_with_g) {
    pairs_at(-1, 1, cut_pair);
    std::memcpy(rgb, cut_pair + kLanes, kLanes * sizeof(*rgb));
  }
  pairs_at(first, pair_count, rgb + first * kLanes);
  const int last = first + 2 * pair_count;
  if (last == width) return;
  pairs_at(last, 1, cut_pair);
  std::memcpy(rgb + static_cast<ptrdiff_t>(last) * kLanes, cut_pair, kLanes * sizeof(*rgb));
}

// Masks RGB pixels that are computed from masked mosaic pixels. Returns true if it masks any.
//   rows  as RowWindow::MoveTo() returns them for the mosaic's mask
bool MaskRow(const std::array<const uint8_t*, 5>& rows, int width, std::vector<uint8_t>* kept,
             uint16_t* rgb) {
  uint8_t least = 255;
  for (int x = 0; x < width; ++x) {
    uint8_t of_all = std::min(rows[0][x], rows[4][x]);
    for (const uint8_t* near : {rows[1], rows[3]})
      of_all = std::min({of_all, near[x - 1], near[x], near[x + 1]});
    for (int dx = -kReach; dx <= kReach; ++dx) of_all = std::min(of_all, rows[2][x + dx]);
    (*kept)[static_cast<size_t>(x)] = of_all;
    least = std::min(least, of_all);
  }
  if (least != 0) return false;
  for (int x = 0; x < width; ++x, rgb += LfPixels::kRgbLanes)
    if ((*kept)[static_cast<size_t>(x)] == 0) std::fill_n(rgb, LfPixels::kRgbLanes, uint16_t{0});
  return true;
}

}  // namespace

PixelRect MosaicRectOf(const PixelRect& rect, int image_width_px, int image_height_px) {
  if (rect.empty()) return {};
  return Intersection(
      {rect.x_begin - kReach, rect.y_begin - kReach, rect.x_end + kReach, rect.y_end + kReach},
      {0, 0, image_width_px, image_height_px});
}

void Demosaic(const LfPixels& mosaic, int image_width_px, int image_height_px,
              const std::array<double, 3>& white_balance, const PixelRect& rect, LfPixels* rgb) {
  LF_CHECK(mosaic.bayer != BayerPattern::kNone && rgb != &mosaic);
  rgb->Reset(rect, BayerPattern::kNone);
  rgb->recorded = mosaic.bayer;
  if (rect.empty()) return;
  LF_CHECK(image_width_px >= 2 && image_height_px >= 2);
  LF_CHECK(Intersection(rect, {0, 0, image_width_px, image_height_px}) == rect);
  const PixelRect needed = MosaicRectOf(rect, image_width_px, image_height_px);
  LF_CHECK(Intersection(needed, mosaic.rect) == needed);

  RowWindow window(mosaic.radiance, mosaic.rect, image_width_px, image_height_px, rect);
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const int first = BayerChannel(mosaic.bayer, rect.x_begin, y);
    const bool begins_with_g = first == 1;
    const int c = begins_with_g ? BayerChannel(mosaic.bayer, rect.x_begin + 1, y) : first;
    DemosaicRow(window.MoveTo(y), begins_with_g, c == 0, GainsOf(white_balance, c), rect.width(),
                rgb->radiance.row(y - rect.y_begin));
  }
  if (!mosaic.any_masked) return;
  RowWindow mask(mosaic.mosaic_mask, mosaic.rect, image_width_px, image_height_px, rect);
  std::vector<uint8_t> kept(static_cast<size_t>(rect.width()));
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    if (MaskRow(mask.MoveTo(y), rect.width(), &kept, rgb->radiance.row(y - rect.y_begin)))
      rgb->any_masked = true;
}

}  // namespace lf
