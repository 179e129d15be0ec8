// The pixels of one LF image, ready for collection.
#pragma once

#include <cstdint>
#include <utility>

#include "lf/core/geometry.h"
#include "lf/core/image.h"

namespace lf {

struct LfPixels {
  // What a kernel adds for an RGB pixel in one go: v of R, G and B, and how many rays they are.
  static constexpr int kRgbLanes = 4;
  static constexpr int kRayLane = 3;
  // Opacities of 0 and 1 as values v. The filters of collection undershoot and overshoot them
  // beside edges, so that there is room on both sides.
  static constexpr uint16_t kTransparent = 4096;
  static constexpr uint16_t kOpaque = 61440;

  LfPixels() = default;
  // Black, nothing masked.
  LfPixels(const PixelRect& part, BayerPattern pattern)
      : radiance(part.width(), part.height(), pattern == BayerPattern::kNone ? kRgbLanes : 1),
        bayer(pattern),
        rect(part) {
    if (pattern == BayerPattern::kNone)
      for (size_t i = kRayLane; i < radiance.pixels().size(); i += kRgbLanes)
        radiance.pixels()[i] = 1;
  }

  // Another part in the same memory, nothing masked; the radiance is left open.
  void Reset(const PixelRect& part, BayerPattern pattern) {
    radiance.Resize(part.width(), part.height(), pattern == BayerPattern::kNone ? kRgbLanes : 1);
    bayer = pattern;
    recorded = BayerPattern::kNone;
    mosaic_mask = {};
    any_masked = false;
    rect = part;
    opacity.Resize(0, 0, kRgbLanes);
  }

  bool IsMasked(int column, int row) const {
    if (bayer == BayerPattern::kNone) return radiance.at(column, row, kRayLane) == 0;
    return !mosaic_mask.empty() && mosaic_mask.at(column, row) == 0;
  }
  // No ray from the pixel at this place of `rect`.
  void Mask(int column, int row) {
    any_masked = true;
    if (bayer == BayerPattern::kNone) {
      for (int lane = 0; lane < kRgbLanes; ++lane) radiance.at(column, row, lane) = 0;
      if (opacity.empty()) return;
      for (int lane = 0; lane < kRgbLanes; ++lane) opacity.at(column, row, lane) = 0;
      return;
    }
    if (mosaic_mask.empty()) mosaic_mask = Image<uint8_t>(rect.width(), rect.height(), 1, 255);
    mosaic_mask.at(column, row) = 0;
  }

  // v of every pixel (capture/radiance.h)  [height][width][1] of a mosaic; otherwise
  // [height][width][4]: R, G, B, and 1, or all 0 where the pixel is masked
  Image<uint16_t> radiance;
  BayerPattern bayer = BayerPattern::kNone;  // at pixel (0, 0) of the whole LF image
  // RGB pixels: the mosaic that they were made from, at pixel (0, 0) of the whole LF image; kNone:
  // all three colours were recorded everywhere
  BayerPattern recorded = BayerPattern::kNone;
  Image<uint8_t> mosaic_mask;  // empty, or of a mosaic [height][width]: 0 = no ray from this pixel
  bool any_masked = false;
  PixelRect rect;  // the part of the LF image that these pixels are
  // Empty, or of RGB pixels of a light field that HasOpacity(): [height][width][4], in the lanes of
  // `radiance`. Opacity stands in for each colour, so that kernels collect it by the same rays and
  // with the same weights.
  Image<uint16_t> opacity;

  // Moves the opacities out, as pixels that kernels take; empty if there are none.
  LfPixels TakeOpacity() {
    LfPixels taken;
    if (opacity.empty()) return taken;
    taken.radiance = std::move(opacity);
    taken.any_masked = any_masked;
    taken.rect = rect;
    opacity = {};
    return taken;
  }

  size_t size_bytes() const {
    return radiance.size_bytes() + mosaic_mask.size_bytes() + opacity.size_bytes();
  }
};

}  // namespace lf
