// SPDX-License-Identifier: Apache-2.0
// The pixels of one LF image, ready for collection.
#pragma once

#include <cstdint>
#include <utility>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/light_field/model/lf_depths.h"

namespace lf {

struct LfPixels {
  // The lanes of an RGB pixel, which a kernel adds at once: the 16-bit radiances of R, G and B, and
  // the number of rays.
  static constexpr int kRgbLanes = 4;
  static constexpr int kRayLane = 3;
  // 16-bit values of the opacities 0 and 1. The 16 bits have room below and above them, because the
  // filters of collection undershoot and overshoot where the opacity changes abruptly.
  static constexpr uint16_t kTransparent = 16384;
  static constexpr uint16_t kOpaque = 49152;

  LfPixels() = default;
  // Creates pixels with the radiance v = 0 and without a mask.
  LfPixels(const PixelRect& part, BayerPattern pattern)
      : radiance(part.width(), part.height(), pattern == BayerPattern::kNone ? kRgbLanes : 1),
        bayer(pattern),
        rect(part) {
    if (pattern == BayerPattern::kNone)
      for (size_t i = kRayLane; i < radiance.pixels().size(); i += kRgbLanes)
        radiance.pixels()[i] = 1;
  }

  // Makes this object hold another part of an LF image, in the same memory, without a mask,
  // opacities, depths and trust. All lanes of `radiance` are unspecified until they are written.
  void Reset(const PixelRect& part, BayerPattern pattern) {
    radiance.Resize(part.width(), part.height(), pattern == BayerPattern::kNone ? kRgbLanes : 1);
    bayer = pattern;
    recorded = BayerPattern::kNone;
    mosaic_mask = {};
    any_masked = false;
    rect = part;
    opacity.Resize(0, 0, kRgbLanes);
    depths = {};
    trust.Resize(0, 0, 1);
  }

  bool IsMasked(int column, int row) const {
    if (bayer == BayerPattern::kNone) return radiance.at(column, row, kRayLane) == 0;
    return !mosaic_mask.empty() && mosaic_mask.at(column, row) == 0;
  }
  // Excludes the pixel at this column and row of `rect`: it sends no ray.
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

  // 16-bit radiance v of every pixel (light_field/model/radiance.h). The shape of a mosaic is
  // [height][width][1], the shape of RGB pixels [height][width][4] with R, G, B and 1, or all 0 if
  // the pixel is masked.
  Image<uint16_t> radiance;
  // Pattern of a mosaic, which begins at pixel (0, 0) of the whole LF image; kNone for RGB pixels.
  BayerPattern bayer = BayerPattern::kNone;
  // The pattern of the mosaic from which RGB pixels were made, beginning at pixel (0, 0) of the
  // whole LF image; kNone if every pixel recorded all three colours.
  BayerPattern recorded = BayerPattern::kNone;
  Image<uint8_t> mosaic_mask;  // [height][width], 0: pixel sends no ray; empty: no mask, or RGB
  bool any_masked = false;
  PixelRect rect;  // the part of the LF image that these pixels cover
  // Opacities of RGB pixels if the light field HasOpacity(), otherwise empty. [height][width][4]
  // with the lanes of `radiance`: the lane of each colour contains the same opacity, so that
  // kernels collect opacities with the same rays and weights as colours.
  Image<uint16_t> opacity;

  // Depths of the whole LF image if the store was opened for them (StoreContent), otherwise empty.
  LfDepths depths;

  // Trust in the pixels of a virtual LF image, [height][width][1] with the shape of `radiance`:
  // from 0 (a guess) to kTrusted (as good as recorded). Empty: all pixels are trusted, as those of
  // recorded LF images are. Loaded like depths.
  static constexpr uint8_t kTrusted = 255;
  Image<uint8_t> trust;

  // Moves the opacities into pixels that kernels can collect. The result is empty if there are no
  // opacities.
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
    return radiance.size_bytes() + mosaic_mask.size_bytes() + opacity.size_bytes() +
           trust.size_bytes();
  }
};

}  // namespace lf
