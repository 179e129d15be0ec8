// SPDX-License-Identifier: Apache-2.0
// A capture of drawn LF images of two planes, for the tests of groups. Internal to this folder.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "lf/core/random.h"
#include "lf/distribute/compress/compress_source.h"
#include "lf/pixels/codec/test_predictions.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {

class DrawnCaptureTest : public FolderTest {
 protected:
  static constexpr int kColumns = 5, kRows = 4, kWidth = 96, kHeight = 72;
  // Inverse depths of the planes.
  static constexpr double kFar = 0.1, kNear = 0.4;

  // Writes the LF images of kColumns x kRows LF cameras.
  //   noise  standard deviation of noise, as a share of white
  template <class Pixel>
  void MakeCapture(PixelLayout layout, double noise = 0) {
    source_ = {};
    LightField& field = source_.light_field;
    field.folder = folder_;
    field.intrinsics = {{100, 100, kWidth / 2.0, kHeight / 2.0, 0, kWidth, kHeight}};
    if (layout == PixelLayout::kMosaic) field.encoding.bayer = BayerPattern::kRggb;
    field.encoding.footprint = PixelFootprint::kArea;
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const double x = 0.05 * column, y = 0.05 * row;
        Image<Pixel> image = DrawnView<Pixel>(x, y, kWidth, kHeight, layout);
        AddNoise(noise, field.size(), &image);
        const std::string name = "image" + std::to_string(field.size()) + ".png";
        ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
        field.image_names.push_back(name);
        LfCamera camera;
        camera.cam_from_world.translation = Vec3(-x, -y, 0);
        field.cameras.push_back(camera);
      }
    source_.whole = IdentityOf(field);
    source_.rects.assign(field.size(), {0, 0, kWidth, kHeight});
  }

  CompressSource source_;

 private:
  template <class Pixel>
  static void AddNoise(double noise, uint64_t stream, Image<Pixel>* image) {
    constexpr double kMost = std::numeric_limits<Pixel>::max();
    if (noise == 0) return;
    uint64_t index = 0;
    for (Pixel& value : image->pixels()) {
      double sum = -6;  // of twelve numbers from 0 to 1: nearly Gaussian, with deviation 1
      for (int i = 0; i < 12; ++i) sum += RandomUnit(5, stream, index++);
      value = static_cast<Pixel>(std::clamp(value + noise * kMost * sum, 0.0, kMost));
    }
  }
};

}  // namespace lf
