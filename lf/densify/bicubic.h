// SPDX-License-Identifier: Apache-2.0
// Bicubic interpolation of the pixels of working images. Internal to this folder.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "lf/core/catmull_rom.h"
#include "lf/core/image.h"
#include "lf/densify/pixel_lanes.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {

// Interpolates as SampleBicubic() between pixels none of which is masked. Returns false if one is.
//   first  of the lanes of the first of four pixels in each row
inline bool SampleShown(const Image<uint16_t>& light, int first, const int rows[4],
                        const std::array<float, 4>& across, const std::array<float, 4>& down,
                        float colour[4]) {
  PixelLanes result = {}, least = {1, 1, 1, 1};
  for (size_t j = 0; j < 4; ++j) {
    const uint16_t* row = light.row(rows[j]) + first;
    PixelLanes sum = {};
    for (size_t i = 0; i < 4; ++i) {
      const PixelLanes pixel = LanesOf(row + i * LfPixels::kRgbLanes);
      least = pixel < least ? pixel : least;
      sum += across[i] * pixel;
    }
    result += down[j] * sum;
  }
  std::memcpy(colour, &result, sizeof(result));
  return least[LfPixels::kRayLane] > 0;
}

// Interpolates between the pixels of WorkingImage::light around continuous position (x, y).
// Premultiplied light and opacity get the same weights, so that the colours of transparent pixels
// have no effect. Positions beyond the border pixels' centres take these pixels. Returns false if
// the position is outside the image, or if one of the four nearest pixels is masked (its last lane
// is 0). Masked pixels farther away count as the nearest pixel.
inline bool SampleBicubic(const Image<uint16_t>& light, float x_px, float y_px, float colour[4]) {
  constexpr int kLanes = LfPixels::kRgbLanes;
  const int width = light.width(), height = light.height();
  if (!(x_px >= 0 && y_px >= 0 && x_px <= static_cast<float>(width) &&
        y_px <= static_cast<float>(height)))
    return false;
  const float x = x_px - 0.5f, y = y_px - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const std::array<float, 4> across = CatmullRomWeights(x - left);
  const std::array<float, 4> down = CatmullRomWeights(y - top);
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  int columns[4], rows[4];
  for (int i = 0; i < 4; ++i) {
    columns[i] = std::clamp(column + i - 1, 0, width - 1) * kLanes;
    rows[i] = std::clamp(row + i - 1, 0, height - 1);
  }
  if (column >= 1 && column + 2 < width &&
      SampleShown(light, columns[0], rows, across, down, colour))
    return true;
  for (int lane = 0; lane < kLanes; ++lane) colour[lane] = 0;
  const uint16_t* nearest =
      light.row(rows[1 + (y - top >= 0.5f)]) + columns[1 + (x - left >= 0.5f)];
  for (int j = 0; j < 4; ++j) {
    const uint16_t* pixels = light.row(rows[j]);
    float sums[kLanes] = {};
    for (int i = 0; i < 4; ++i) {
      const uint16_t* pixel = pixels + columns[i];
      if (pixel[LfPixels::kRayLane] == 0) {
        if ((i == 1 || i == 2) && (j == 1 || j == 2)) return false;
        pixel = nearest;
      }
      for (int lane = 0; lane < kLanes; ++lane)
        sums[lane] += across[static_cast<size_t>(i)] * static_cast<float>(pixel[lane]);
    }
    for (int lane = 0; lane < kLanes; ++lane)
      colour[lane] += down[static_cast<size_t>(j)] * sums[lane];
  }
  return true;
}

// Rounds an interpolated value to 16 bits.
inline uint16_t RoundToLight(float value) {
  return static_cast<uint16_t>(std::clamp(value + 0.5f, 0.0f, 65535.0f));
}

// Returns the share of the light behind a pixel that it covers, from 0 to 1: exactly 1 if its
// interpolated last lane is within rounding errors of that of opaque pixels.
inline float OpacityOfLane(float lane) {
  if (lane >= static_cast<float>(kMostOpacity)) return 1;
  return std::max(0.0f, (lane - 1) / static_cast<float>(kMostOpacity));
}

// Rounds an interpolated pixel of WorkingImage::light that is not masked. Where the interpolation
// of an outline makes the opacity larger than 1, it makes the light too bright by the same factor,
// which is divided by.
//   black  WorkingImage::black
inline void RoundPixel(const float colour[LfPixels::kRgbLanes], uint16_t black, uint16_t* pixel) {
  constexpr float kOpaque = kOpaqueOpacity, kRounding = 1;
  const float lane = colour[LfPixels::kRayLane];
  const bool is_above = lane > kOpaque + kRounding;
  const float factor = is_above ? (kOpaque - 1) / (lane - 1) : 1;
  for (int c = 0; c < LfPixels::kRayLane; ++c)
    pixel[c] = RoundToLight(is_above ? black + (colour[c] - black) * factor : colour[c]);
  pixel[LfPixels::kRayLane] = std::max<uint16_t>(RoundToLight(lane), 1);
}

}  // namespace lf
