// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/compared_tones.h"

#include <algorithm>

#include "lf/densify/working_image.h"

namespace lf {
namespace {

constexpr int kReach = 4;  // pixels around one whose tones make its mean

bool IsShown(const uint16_t* tones) {
  return tones[LfPixels::kRayLane] != 0 && !IsTransparent(tones);
}

// Sums the tones around each pixel of a row or column: over the pixels up to kReach before and
// behind it.
//   first  the first of `count` pixels, whose values are `step` apart
//   sums   results, one for each pixel, at the same distances
void AddAround(const uint16_t* first, size_t step, int count, uint16_t* sums) {
  uint32_t sum[LfPixels::kRgbLanes] = {};
  const auto add = [&](int at, int sign) {
    if (at < 0 || at >= count) return;
    const uint16_t* values = first + static_cast<size_t>(at) * step;
    for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
      sum[lane] += static_cast<uint32_t>(sign * values[lane]);
  };
  for (int i = 0; i < kReach; ++i) add(i, 1);
  for (int i = 0; i < count; ++i) {
    add(i + kReach, 1);
    for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
      sums[static_cast<size_t>(i) * step + static_cast<size_t>(lane)] =
          static_cast<uint16_t>(sum[lane]);
    add(i - kReach, -1);
  }
}

}  // namespace

Image<uint16_t> ComparedTones(const Image<uint16_t>& tones) {
  constexpr int kHalfOfWhite = 64, kMostTone = 255;
  const int width = tones.width(), height = tones.height();
  // Tones of pixels that are shown, each with 1 in the last lane. A sum over 9 x 9 pixels is at
  // most 81 * 255.
  Image<uint16_t> shown(width, height, LfPixels::kRgbLanes);
  for (size_t i = 0; i < tones.pixels().size(); i += LfPixels::kRgbLanes) {
    const uint16_t* pixel = tones.pixels().data() + i;
    if (!IsShown(pixel)) continue;
    std::copy(pixel, pixel + LfPixels::kRayLane, shown.pixels().data() + i);
    shown.pixels()[i + LfPixels::kRayLane] = 1;
  }
  Image<uint16_t> sums = shown;
  for (int y = 0; y < height; ++y)
    AddAround(shown.row(y), LfPixels::kRgbLanes, width, &sums.at(0, y));
  for (int x = 0; x < width; ++x)
    AddAround(&sums.at(x, 0), static_cast<size_t>(width) * LfPixels::kRgbLanes, height,
              &shown.at(x, 0));
  Image<uint16_t> compared = tones;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const uint16_t* sum = &shown.at(x, y);
      if (!IsShown(&tones.at(x, y))) continue;
      const int twice = 2 * sum[LfPixels::kRayLane];
      for (int lane = 0; lane < LfPixels::kRayLane; ++lane) {
        const int half_mean = (sum[lane] + twice / 2) / twice;
        compared.at(x, y, lane) = static_cast<uint16_t>(
            std::clamp(tones.at(x, y, lane) - half_mean + kHalfOfWhite, 0, kMostTone));
      }
    }
  return compared;
}

}  // namespace lf
