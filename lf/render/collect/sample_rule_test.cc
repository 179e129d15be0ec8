// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/sample_rule.h"

#include <gtest/gtest.h>

#include "lf/collection/gather.h"
#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

TEST(SampleRule, IsAskedAboutEvery64ImagesOfAFrame) {
  EXPECT_EQ(DecisionRanks(1000, 1000), 64u);
  EXPECT_EQ(DecisionRanks(1000, 501), 64u);
  EXPECT_EQ(DecisionRanks(1000, 500), 128u);
  EXPECT_EQ(DecisionRanks(1000, 30), 64u * 32);
  EXPECT_EQ(DecisionRanks(1000, 0), DecisionRanks(1000, 1));
  EXPECT_EQ(DecisionRanks(size_t{1} << 32, 1), 1u << 30);
}

// Compares ReachableElements with the counts of a plate that was collected by the estimator
// bilinear, which tests every element.
TEST(SampleRule, ElementsAreReachableWhereTheyGetRays) {
  const LightField field = testing::NoiseField();
  const testing::NoiseStore store;
  ThreadPool pool(2);
  for (RenderCamera camera : testing::NoiseFrames()) {
    // The view is so wide that no LF image sees its borders.
    camera.pinhole.intrinsics = {60, 60, 80, 40, 0, 160, 80};
    SensorPlate plate(160, 80);
    for (uint32_t i = 0; i < field.size(); ++i) {
      LfPixels pixels;
      ASSERT_TRUE(store.Load(LfImageId{i}, {0, 0, testing::kWidth, testing::kHeight}, &pixels));
      GatherReference(field.Camera(LfImageId{i}), pixels, camera, &plate);
    }
    const ReachableElements reachable(ImageIndex(field), camera, {},
                                      {.reach = PixelReach::kElement}, PixelFilter::kAuto, pool);
    EXPECT_GT(reachable.count(), 1000u);
    EXPECT_LT(reachable.count(), 12000u);
    for (int y = 4; y < 80; y += 8)
      for (int x = 4; x < 160; x += 8)
        EXPECT_EQ(reachable.Holds(x, y), plate.At(x, y, 0).count > 0) << x << " " << y;
    // There is no LF image at the ranks 5 to 5, so no element is reachable.
    EXPECT_EQ(ReachableElements(ImageIndex(field), camera, {5, 5}, {}, {}, pool).count(), 0u);
  }
}

TEST(SampleRule, CountsEveryChannelOfReachableElementsAlone) {
  const LightField field = testing::NoiseField();
  ThreadPool pool(1);
  RenderCamera camera = testing::NoiseFrames()[0];
  camera.pinhole.intrinsics = {60, 60, 80, 40, 0, 160, 80};
  const ReachableElements reachable(ImageIndex(field), camera, {}, {}, {}, pool);
  for (int sparse = 0; sparse < 3; ++sparse) {
    SensorPlate plate(160, 80);
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 160; ++x)
        if (reachable.Holds(x, y))
          for (int c = 0; c < 3; ++c) plate.Add(x, y, c, {0, c == sparse ? 5u : 9u});
    EXPECT_TRUE(HasSamples(plate, reachable, 5));
    EXPECT_FALSE(HasSamples(plate, reachable, 6));
    EXPECT_EQ(MeasureSamples(plate, reachable, 5).share, 1);
    EXPECT_EQ(MeasureSamples(plate, reachable, 6).share, 0);
    EXPECT_EQ(MeasureSamples(plate, reachable, 6).most_have, 5u);
    // One per cent of the elements may have fewer rays.
    size_t left = reachable.count() - reachable.count() / 100;
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 160; ++x)
        if (reachable.Holds(x, y) && left > 0) {
          plate.Add(x, y, sparse, {0, 4});
          --left;
        }
    EXPECT_TRUE(HasSamples(plate, reachable, 9));
    EXPECT_EQ(MeasureSamples(plate, reachable, 9).most_have, 9u);
    EXPECT_NEAR(MeasureSamples(plate, reachable, 9).share, 0.99, 0.001);
  }
  SensorPlate nothing(160, 80);
  EXPECT_FALSE(HasSamples(nothing, reachable, 1));
  EXPECT_EQ(MeasureSamples(nothing, reachable, 1).most_have, 0u);
}

}  // namespace
}  // namespace lf
