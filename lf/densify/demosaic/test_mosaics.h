// SPDX-License-Identifier: Apache-2.0
// Mosaics of textured walls whose colours are known, for tests. Internal to this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lf/core/random.h"
#include "lf/core/test_value_noise.h"
#include "lf/densify/demosaic/joint_image.h"
#include "lf/densify/test_world.h"

namespace lf {

// A light field of mosaics in memory. White balance, black level and gains differ from 1 and 0.
struct DrawnMosaics {
  static constexpr int kWidth = 96, kHeight = 64;
  static constexpr double kNoLight = 4096;  // stored value and 16-bit radiance

  LightField field;
  std::vector<LfPixels> mosaics;  // as they are loaded: 16-bit radiance
  std::vector<Image<float>> rgb;  // [LF image]: [height][width][3], white balanced radiance

  explicit DrawnMosaics(BayerPattern pattern = BayerPattern::kRggb) {
    field.intrinsics = {CameraAt(0, 0, kWidth, kHeight).intrinsics};
    field.encoding.bayer = pattern;
    field.encoding.transfer = Transfer::kLinear;
    field.encoding.black_level = kNoLight;
    field.encoding.pedestal = kNoLight;
    field.encoding.white_balance = {2, 1, 1.5};
    field.encoding.footprint = PixelFootprint::kArea;
  }

  // Photographs the walls, whose texture has details of about two pixels.
  void Add(const PinholeCamera& camera, const std::vector<Wall>& walls, float gain = 1) {
    constexpr double kPixelsPerDetail = 2;
    LfPixels mosaic({0, 0, kWidth, kHeight}, field.encoding.bayer);
    Image<float> colours(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        Vec3 point = Vec3::Zero();
        const Wall* const wall = WallAt(camera, walls, x + 0.5, y + 0.5, &point);
        const double scale = camera.intrinsics.fx_px / wall->depth / kPixelsPerDetail;
        const auto noise = [&](uint64_t colour) {
          return ValueNoise(point.x() * scale, point.y() * scale, wall->seed * 4 + colour);
        };
        // Colours have details in common, and details of their own.
        for (int c = 0; c < 3; ++c)
          colours.at(x, y, c) =
              static_cast<float>(0.1 + 0.2 * noise(3) + 0.15 * noise(static_cast<uint64_t>(c)));
        const int c = BayerChannel(field.encoding.bayer, x, y);
        const double radiance =
            colours.at(x, y, c) / field.encoding.white_balance[static_cast<size_t>(c)];
        mosaic.radiance.at(x, y) = static_cast<uint16_t>(
            std::lround(radiance * field.encoding.Scale() + field.encoding.pedestal));
      }
    LfCamera lf_camera;
    lf_camera.cam_from_world = camera.cam_from_world;
    lf_camera.gain = ChannelGains(gain);
    field.cameras.push_back(lf_camera);
    field.image_names.push_back("image" + std::to_string(field.size()) + ".png");
    mosaics.push_back(std::move(mosaic));
    rgb.push_back(std::move(colours));
  }

  // Adds LF images of cameras around (0, 0), at uneven distances, the first one at (0, 0).
  void AddGrid(const std::vector<Wall>& walls, int side = 5) {
    constexpr double kDistance = 0.05;
    Add(CameraAt(0, 0, kWidth, kHeight), walls);
    uint64_t index = 0;
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column) {
        const auto place = [&](int i) {
          return kDistance * (i - side / 2 + 0.4 * (2 * RandomUnit(3, 4, index++) - 1));
        };
        const double x = place(column), y = place(row);
        if (row == side / 2 && column == side / 2) continue;
        Add(CameraAt(x, y, kWidth, kHeight), walls);
      }
  }

  JointImage ImageOf(uint32_t id) const {
    return JointImageOf(field, LfImageId{id}, mosaics[id], ToneCurve(field.encoding));
  }

  // Returns the mean squared error of white balanced colours, without a border.
  double ErrorOf(const Image<float>& found, uint32_t id) const {
    constexpr int kBorder = 12;
    double sum = 0, count = 0;
    for (int y = kBorder; y < kHeight - kBorder; ++y)
      for (int x = kBorder; x < kWidth - kBorder; ++x)
        for (int c = 0; c < 3; ++c, ++count)
          sum += std::pow(found.at(x, y, c) - rgb[id].at(x, y, c), 2);
    return sum / count;
  }
};

}  // namespace lf
