// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/brightness.h"

#include <algorithm>

namespace lf {
namespace {

template <class Pixel>
int64_t QuadrupleBrightness(const Pixel* pixel, int channels) {
  if (channels == 3) return int64_t{pixel[0]} + 2 * int64_t{pixel[1]} + pixel[2];
  if (channels == 4) return int64_t{pixel[0]} + pixel[1] + pixel[2] + pixel[3];
  return 4 * int64_t{pixel[0]};
}

}  // namespace

template <class Pixel>
BrightnessRange RangeOf(ImageView<const Pixel> pixels) {
  if constexpr (sizeof(Pixel) == 1) return {};
  Pixel least = pixels.at(0, 0), greatest = least;
  for (int y = 0; y < pixels.height; ++y) {
    const Pixel* const row = pixels.row(y);
    const auto [low, high] =
        std::minmax_element(row, row + static_cast<size_t>(pixels.width) * pixels.channels);
    least = std::min(least, *low);
    greatest = std::max(greatest, *high);
  }
  return {least, std::max<int>(greatest, least + 255)};
}
template BrightnessRange RangeOf(ImageView<const uint8_t>);
template BrightnessRange RangeOf(ImageView<const uint16_t>);

template <class Pixel>
Image<uint8_t> BrightnessOf(ImageView<const Pixel> pixels, const BrightnessRange& range) {
  Image<uint8_t> brightness(pixels.width, pixels.height);
  const int64_t black = 4 * int64_t{range.black}, span = 4 * (int64_t{range.white} - range.black);
  for (int y = 0; y < pixels.height; ++y) {
    const Pixel* in = pixels.row(y);
    uint8_t* const out = brightness.row(y);
    for (int x = 0; x < pixels.width; ++x, in += pixels.channels) {
      const int64_t value = QuadrupleBrightness(in, pixels.channels);
      if constexpr (sizeof(Pixel) == 1)
        out[x] = static_cast<uint8_t>((value + 2) >> 2);
      else
        out[x] = static_cast<uint8_t>(
            std::clamp<int64_t>((255 * (value - black) + span / 2) / span, 0, 255));
    }
  }
  return brightness;
}
template Image<uint8_t> BrightnessOf(ImageView<const uint8_t>, const BrightnessRange&);
template Image<uint8_t> BrightnessOf(ImageView<const uint16_t>, const BrightnessRange&);

}  // namespace lf
