// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/image_feather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/camera/ray_weight.h"
#include "lf/camera/testing_scenes.h"

namespace lf {
namespace {

TEST(ImageFeather, GrowsSmoothlyFromTheBorder) {
  const Intrinsics k = {500, 500, 320, 160, 0, 640, 320};  // the feathered border is 10 pixels wide
  EXPECT_EQ(FeatherAt(k, 320, 160), 1);
  EXPECT_EQ(FeatherAt(k, 10.5, 160), 1);
  EXPECT_EQ(FeatherAt(k, 629.5, 309.5), 1);
  EXPECT_DOUBLE_EQ(FeatherAt(k, 5.5, 160), 0.5);
  EXPECT_DOUBLE_EQ(FeatherAt(k, 320, 314.5), 0.5);
  EXPECT_DOUBLE_EQ(FeatherAt(k, 5.5, 5.5), 0.25);
  for (const double outside : {0.5, 0.0, -100.0}) {
    EXPECT_EQ(FeatherAt(k, outside, 160), 0);
    EXPECT_EQ(FeatherAt(k, 640 - outside, 160), 0);
    EXPECT_EQ(FeatherAt(k, 320, outside), 0);
  }
  for (double x = 0.5; x < 12; x += 0.25) {
    const double step = FeatherAt(k, x + 0.25, 160) - FeatherAt(k, x, 160);
    EXPECT_GE(step, 0);
    EXPECT_LE(step, 0.25 * 1.5 / 10 + 1e-12);  // the steepest slope of the cubic
  }
}

// Computes the feather by its definition: at the position where the LF camera records the ray
// through the focus point.
double Literally(const testing::CameraPair& pair, double x, double y) {
  const auto focus = FocusPointOfElement(pair.render_camera, x, y);
  if (!focus) return 0;
  const RayThrough ray(pair.lf_camera, pair.render_camera.pinhole.ForwardWorld());
  const auto recorded = ray.RecordedAt(ray.DirectionWorld(*focus));
  if (!recorded) return 0;
  return FeatherAt(pair.lf_camera.intrinsics, recorded->x(), recorded->y());
}

TEST(ImageFeather, IsWholeInRectanglesThatItCallsWhole) {
  size_t whole = 0, feathered = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const testing::CameraPair pair =
        seed % 10 == 0 ? testing::RandomDistortedPair(seed) : testing::RandomCameraPair(seed);
    const ImageFeather feather(pair.lf_camera, pair.render_camera);
    const Intrinsics& plate = pair.render_camera.pinhole.intrinsics;
    for (int y = 0; y + 16 <= plate.height_px; y += 16)
      for (int x = 0; x + 24 <= plate.width_px; x += 24) {
        const bool is_whole = feather.IsWhole({x, y, x + 24, y + 16});
        uint16_t corners[12];
        feather.OfCorners(x, y, 4, 3, corners);
        const bool all_are = std::all_of(std::begin(corners), std::end(corners),
                                         [](uint16_t corner) { return corner == kWholeFeather; });
        EXPECT_TRUE(all_are || !is_whole) << seed;
        whole += is_whole;
        feathered += !all_are;
      }
  }
  EXPECT_GT(whole, 300u);
  EXPECT_GT(feathered, 300u);
}

TEST(ImageFeather, FollowsTheRaysOfAnyPairOfCameras) {
  size_t whole = 0, part = 0, none = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const testing::CameraPair pair =
        seed % 2 == 0 ? testing::RandomCameraPair(seed) : testing::RandomDistortedPair(seed);
    const ImageFeather feather(pair.lf_camera, pair.render_camera);
    const Intrinsics& plate = pair.render_camera.pinhole.intrinsics;
    // Rectangles of every size: nearly all borders of LF images miss a small one.
    const int columns = seed % 3 == 0 ? 2 : plate.width_px / kWeightBlock + 1;
    const int rows = 1 + static_cast<int>(seed / 3 % 9);
    std::vector<uint16_t> corners(static_cast<size_t>(columns) * rows);
    for (int y = -5; y < plate.height_px + 8; y += rows * kWeightBlock)
      for (int x = -3; x < plate.width_px; x += columns * kWeightBlock) {
        feather.OfCorners(x, y, columns, rows, corners.data());
        for (int j = 0; j < rows; ++j)
          for (int i = 0; i < columns; ++i) {
            const uint16_t corner = corners[static_cast<size_t>(j) * columns + i];
            const double wanted = Literally(pair, x + i * kWeightBlock, y + j * kWeightBlock);
            EXPECT_NEAR(corner, kWholeFeather * wanted, 0.5 + 1e-6) << seed;
            uint16_t alone = 0;
            feather.OfCorners(x + i * kWeightBlock, y + j * kWeightBlock, 1, 1, &alone);
            EXPECT_EQ(alone, corner) << seed;
            whole += corner == kWholeFeather ? 1 : 0;
            none += corner == 0 ? 1 : 0;
            part += corner > 0 && corner < kWholeFeather ? 1 : 0;
          }
      }
  }
  EXPECT_GT(whole, 1000u);
  EXPECT_GT(part, 1000u);
  EXPECT_GT(none, 1000u);
}

}  // namespace
}  // namespace lf
