// SPDX-License-Identifier: Apache-2.0
#include "lf/live/picture_lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/test_noise_field.h"
#include "lf/selection/image_index.h"

namespace lf {
namespace {

// Returns the weight of an element as a renderer elsewhere computes it.
double WeightAt(const PictureLens& lens, size_t image, const Intrinsics& plate, int x, int y) {
  const WeightBlocks& blocks = lens.images[image].blocks;
  // Position of the middle of a block among the nodes, in whole steps of 1/256.
  const auto place = [](int end, int size_px, int count) {
    const int middle = std::clamp(end - kWeightBlock / 2, 0, size_px - 1);
    return std::floor(256.0 * middle * (count - 1) / size_px) / 256;
  };
  const double across = place(blocks.EndX(x), plate.width_px, lens.columns);
  const double down = place(blocks.EndY(y), plate.height_px, lens.rows);
  const auto node = [&](double column, double row) {
    const int i = std::min(static_cast<int>(column), lens.columns - 1);
    const int j = std::min(static_cast<int>(row), lens.rows - 1);
    return lens.nodes[(image * static_cast<size_t>(lens.rows) + j) * lens.columns + i] / 256.0;
  };
  const double u = across - std::floor(across), v = down - std::floor(down);
  const double above = node(across, down) * (1 - u) + node(across + 1, down) * u;
  const double below = node(across, down + 1) * (1 - u) + node(across + 1, down + 1) * u;
  return std::floor(above * (1 - v) + below * v + 0.5);
}

TEST(PictureLens, WeightsAreThoseOfTheFrame) {
  const LightField field = testing::NoiseField();
  const ImageIndex index(field);
  ThreadPool pool(2);
  SelectOptions select;
  select.reach = PixelReach::kNeighbours;
  for (const RenderCamera& frame : testing::NoiseFrames())
    for (const double radius_w : {0.0, 0.01, 0.03}) {
      RenderCamera opened = frame;
      opened.aperture.radius_w = radius_w;
      const FrameLens expected(index, opened, LensWeights::kAuto, select, pool);
      const PictureLens lens = LensOfPicture(field, opened, LensWeights::kAuto, pool);
      const Intrinsics& plate = frame.pinhole.intrinsics;
      EXPECT_TRUE(lens.has_feather);
      EXPECT_EQ(lens.opening.radius_w, expected.camera().aperture.radius_w);
      ASSERT_EQ(lens.nodes.size(), lens.images.size() * lens.columns * lens.rows);
      size_t at = 0;
      for (uint32_t i = 0; i < field.size(); ++i) {
        if (!expected.Takes(LfImageId{i})) continue;
        ASSERT_LT(at, lens.images.size());
        ASSERT_EQ(lens.images[at].index, i);
        for (int y = 0; y < plate.height_px; ++y)
          for (int x = 0; x < plate.width_px; ++x)
            ASSERT_EQ(WeightAt(lens, at, plate, x, y),
                      expected.weights()->At(*expected.IndexOf(LfImageId{i}), x, y))
                << i << ": " << x << ", " << y;
        ++at;
      }
      EXPECT_EQ(at, lens.images.size());
      EXPECT_GT(at, 0U);
    }
}

TEST(PictureLens, WithoutWeightsRaysAreTestedAgainstTheAperture) {
  const LightField field = testing::NoiseField();
  const RenderCamera frame = testing::NoiseFrames()[1];
  ThreadPool pool(1);
  const PictureLens lens = LensOfPicture(field, frame, LensWeights::kNone, pool);
  EXPECT_FALSE(lens.has_feather);
  EXPECT_EQ(lens.opening.blades, 5);
  EXPECT_EQ(lens.opening.radius_w, frame.aperture.radius_w);
  EXPECT_EQ(lens.images.size(), field.size());
  EXPECT_EQ(lens.nodes, std::vector<uint16_t>(field.size(), 256));
}

TEST(PictureLens, FinerLfPixelsAreSampled) {
  const LightField field = testing::NoiseField();
  RenderCamera coarse = testing::NoiseFrames()[0];
  coarse.pinhole.intrinsics = {20, 20, 10, 7.5, 0, 20, 15};
  ThreadPool pool(1);
  for (const PictureLens::Image& image :
       LensOfPicture(field, coarse, LensWeights::kAuto, pool).images)
    EXPECT_EQ(image.samples, 4);
}

}  // namespace
}  // namespace lf
