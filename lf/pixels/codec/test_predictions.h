// SPDX-License-Identifier: Apache-2.0
// Drawn images of two planes with known parallax, for tests and benchmarks of predicted images.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lf/core/check.h"
#include "lf/pixels/codec/predicted_image.h"

namespace lf {

// Brightness of a place of a plane: waves of several lengths and directions, fine stripes among
// them.
inline double DrawnTexture(double x, double y) {
  return 0.5 + 0.13 * std::sin(0.31 * x + 0.11 * y) + 0.12 * std::sin(0.17 * y - 0.23 * x + 1) +
         0.08 * std::sin(0.05 * x + 0.41 * y) + 0.07 * std::sin(0.9 * x - 0.7 * y) +
         0.05 * std::sin(1.3 * x + 0.2 * y + 2);
}

// Draws what a camera at (x, y) sees: a near plane, of depth index 40, in the right half, before a
// far one, of depth index 10. A plane of depth index d is moved by d * (x, y) pixels to the left
// and upwards. Colours of RGB and mosaics differ; a mosaic has a row of red and green pixels, and
// one of green and blue ones, in turn.
template <class Pixel>
Image<Pixel> DrawnView(double x, double y, int width, int height, PixelLayout layout) {
  constexpr double kMost = std::numeric_limits<Pixel>::max();
  Image<Pixel> image(width, height, layout == PixelLayout::kRgb ? 3 : 1);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const double near_x = column + 40 * x, near_y = row + 40 * y;
      const double value = near_x >= width / 2
                               ? DrawnTexture(near_x, near_y)
                               : DrawnTexture(500 + column + 10 * x, 300 + row + 10 * y);
      for (int c = 0; c < image.channels(); ++c) {
        const int colour = layout == PixelLayout::kMosaic ? row % 2 + column % 2 : c;
        const double gain = layout == PixelLayout::kGrey ? 1 : 1 - 0.2 * colour;
        image.at(column, row, c) =
            static_cast<Pixel>(std::lround(std::clamp(gain * value, 0.0, 1.0) * kMost));
      }
    }
  return image;
}

// Returns the warp from the camera at (0, 0) to one at (x, y).
inline PlaneWarp DrawnWarp(double x, double y, PixelLayout layout) {
  const double unit = layout == PixelLayout::kMosaic ? 0.5 : 1;  // squares of 2 x 2 pixels
  PlaneWarp warp = IdentityWarp();
  warp.step[0] = -std::llround(unit * x * (1 << kWarpBits));
  warp.step[1] = -std::llround(unit * y * (1 << kWarpBits));
  return warp;
}

// An image, and cameras around it as reference images, decoded at the settings.
struct DrawnGroup {
  CodecPixels target;
  std::vector<DecodedPart> decoded;
  std::vector<PlaneWarp> warps;

  std::vector<Reference> references() const {
    std::vector<Reference> all;
    for (size_t r = 0; r < decoded.size(); ++r) all.push_back({&decoded[r].pixels, warps[r]});
    return all;
  }
  std::vector<const DecodedPart*> parts() const {
    std::vector<const DecodedPart*> all;
    for (const DecodedPart& part : decoded) all.push_back(&part);
    return all;
  }
};

template <class Pixel>
DrawnGroup MakeDrawnGroup(int reference_count, int width, int height, PixelLayout layout,
                          const CodecSettings& settings) {
  constexpr double kCameras[4][2] = {{0.25, 0.1}, {-0.25, 0}, {0.05, 0.25}, {0, -0.2}};
  DrawnGroup group;
  group.target = DrawnView<Pixel>(0, 0, width, height, layout);
  for (int r = 0; r < reference_count; ++r) {
    const auto [x, y] = kCameras[r];
    const std::string code =
        EncodeImage(DrawnView<Pixel>(x, y, width, height, layout), layout, settings);
    LF_CHECK(DecodeImage(code, &group.decoded.emplace_back()).has_value());
    group.warps.push_back(DrawnWarp(x, y, layout));
  }
  return group;
}

}  // namespace lf
