// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/demosaic.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "lf/core/check.h"
#include "lf/storage/load/demosaic_arithmetic.h"
#include "lf/storage/load/demosaic_strip.h"

namespace lf {
namespace {

// Mosaic pixels on each side of a pixel from which it is computed: 11 in steps 0 to 5, and 2 around
// masked ones among them.
constexpr int kReach = 13;
// Mosaic pixels that mask an RGB pixel.
constexpr int kMaskReach = 2;

// Five rows of the mask of a mosaic, with mirrored ends: all that mask one row of RGB pixels.
class MaskWindow {
 public:
  MaskWindow(const Image<uint8_t>& mask, const PixelRect& mosaic_rect, int image_width,
             int image_height, const PixelRect& rect)
      : mask_(mask),
        mosaic_rect_(mosaic_rect),
        image_width_(image_width),
        image_height_(image_height),
        rect_(rect),
        next_row_(std::max(0, rect.y_begin - kMaskReach)),
        stride_(static_cast<size_t>(rect.width()) + 2 * kMargin),
        values_(stride_ * kRows) {}

  // Returns pointers to rows y - 2 to y + 2, at column rect.x_begin. y must grow from call to call.
  std::array<const uint8_t*, 5> MoveTo(int y) {
    for (; next_row_ <= std::min(y + kMaskReach, image_height_ - 1); ++next_row_) Fill(next_row_);
    std::array<const uint8_t*, 5> rows;
    for (int i = 0; i < kRows; ++i) rows[i] = Row(Mirrored(y + i - kMaskReach, image_height_));
    return rows;
  }

 private:
  static constexpr int kRows = 2 * kMaskReach + 1;
  static constexpr int kMargin = kMaskReach;

  uint8_t* Row(int y) {
    return values_.data() + static_cast<size_t>(y % kRows) * stride_ + kMargin;
  }

  void Fill(int y) {
    const uint8_t* const in = mask_.row(y - mosaic_rect_.y_begin);
    uint8_t* const out = Row(y);
    const auto copy = [&](int begin, int end) {
      for (int x = begin; x < end; ++x)
        out[x - rect_.x_begin] = in[Mirrored(x, image_width_) - mosaic_rect_.x_begin];
    };
    const int begin = std::max(0, rect_.x_begin - kMaskReach);
    const int end = std::min(image_width_, rect_.x_end + kMaskReach);
    copy(rect_.x_begin - kMaskReach, begin);
    std::memcpy(out + (begin - rect_.x_begin), in + (begin - mosaic_rect_.x_begin),
                static_cast<size_t>(end - begin));
    copy(end, rect_.x_end + kMaskReach);
  }

  const Image<uint8_t>& mask_;
  const PixelRect mosaic_rect_;
  const int image_width_, image_height_;
  const PixelRect rect_;
  int next_row_;
  size_t stride_;
  std::vector<uint8_t> values_;
};

// Masks RGB pixels that are computed from masked mosaic pixels. Returns true if it masks any.
//   rows  as MaskWindow::MoveTo() returns them
bool MaskRow(const std::array<const uint8_t*, 5>& rows, int width, std::vector<uint8_t>* kept,
             uint16_t* rgb) {
  uint8_t least = 255;
  for (int x = 0; x < width; ++x) {
    uint8_t of_all = std::min(rows[0][x], rows[4][x]);
    for (const uint8_t* near : {rows[1], rows[3]})
      of_all = std::min({of_all, near[x - 1], near[x], near[x + 1]});
    for (int dx = -kMaskReach; dx <= kMaskReach; ++dx) of_all = std::min(of_all, rows[2][x + dx]);
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
              const RadianceEncoding& encoding, const PixelRect& rect, LfPixels* rgb) {
  LF_CHECK(mosaic.bayer != BayerPattern::kNone && rgb != &mosaic);
  rgb->Reset(rect, BayerPattern::kNone);
  rgb->recorded = mosaic.bayer;
  if (rect.empty()) return;
  LF_CHECK(image_width_px >= 2 && image_height_px >= 2);
  LF_CHECK(Intersection(rect, {0, 0, image_width_px, image_height_px}) == rect);
  const PixelRect needed = MosaicRectOf(rect, image_width_px, image_height_px);
  LF_CHECK(Intersection(needed, mosaic.rect) == needed);

  const BalancedLevels levels(encoding);
  thread_local StripMemory memory;
  for (int x = rect.x_begin; x < rect.x_end; x += kStripColumns)
    DemosaicStrip({mosaic, image_width_px, image_height_px}, levels,
                  {x, rect.y_begin, std::min(x + kStripColumns, rect.x_end), rect.y_end}, &memory,
                  rgb);
  if (!mosaic.any_masked) return;
  MaskWindow mask(mosaic.mosaic_mask, mosaic.rect, image_width_px, image_height_px, rect);
  std::vector<uint8_t> kept(static_cast<size_t>(rect.width()));
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    if (MaskRow(mask.MoveTo(y), rect.width(), &kept, rgb->radiance.row(y - rect.y_begin)))
      rgb->any_masked = true;
}

}  // namespace lf
