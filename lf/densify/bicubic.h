// SPDX-License-Identifier: Apache-2.0
// Bicubic interpolation of RGB pixels. Internal to this folder.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lf/core/catmull_rom.h"
#include "lf/core/image.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// Interpolates between the pixels [height][width][4] around continuous position (x, y). Positions
// beyond the border pixels' centres take these pixels. Returns false if the position is outside the
// image, or if one of the four nearest pixels is masked (its last lane is 0). Masked pixels farther
// away count as the nearest pixel.
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

}  // namespace lf
