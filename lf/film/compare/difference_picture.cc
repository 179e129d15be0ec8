// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/difference_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/film/develop/display.h"

namespace lf {
namespace {

// Colours of the map at equal distances: the lightness grows evenly from each to the next.
constexpr std::array<std::array<int, 3>, 9> kColours = {{{0, 0, 4},
                                                         {28, 16, 68},
                                                         {79, 18, 123},
                                                         {129, 37, 129},
                                                         {181, 54, 122},
                                                         {229, 80, 100},
                                                         {251, 135, 97},
                                                         {254, 194, 135},
                                                         {252, 253, 191}}};

double DisplayOf(float light) {
  return std::isfinite(light) ? DisplayFromLinear(std::clamp(light, 0.0f, 1.0f)) : 0;
}

}  // namespace

Image<uint8_t> FlipPicture(const Image<float>& flip) {
  Image<uint8_t> picture(flip.width(), flip.height(), 3);
  constexpr int kSteps = static_cast<int>(kColours.size()) - 1;
  for (int y = 0; y < flip.height(); ++y)
    for (int x = 0; x < flip.width(); ++x) {
      const double place = std::clamp(flip.at(x, y), 0.0f, 1.0f) * kSteps;
      const int step = std::min(static_cast<int>(place), kSteps - 1);
      for (int c = 0; c < 3; ++c)
        picture.at(x, y, c) = static_cast<uint8_t>(
            std::lround(std::lerp(kColours[step][c], kColours[step + 1][c], place - step)));
    }
  return picture;
}

Image<uint8_t> SignedDifferencePicture(const PictureLight& reference, const PictureLight& test,
                                       double gain) {
  const Image<float>&a = reference.rgb, &b = test.rgb;
  Image<uint8_t> picture(a.width(), a.height(), 3);
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        const double difference = DisplayOf(b.at(x, y, c)) - DisplayOf(a.at(x, y, c));
        picture.at(x, y, c) = static_cast<uint8_t>(
            std::lround(255 * std::clamp(0.5 + 0.5 * gain * difference, 0.0, 1.0)));
      }
  return picture;
}

}  // namespace lf
