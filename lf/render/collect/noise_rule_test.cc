// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/noise_rule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

TEST(NoiseRule, IsAskedEightTimesForEachDoubling) {
  EXPECT_EQ(NoiseDecisionAfter(0), 16u);
  EXPECT_EQ(NoiseDecisionAfter(15), 16u);
  EXPECT_EQ(NoiseDecisionAfter(16), 18u);
  EXPECT_EQ(NoiseDecisionAfter(17), 18u);
  EXPECT_EQ(NoiseDecisionAfter(30), 32u);
  EXPECT_EQ(NoiseDecisionAfter(32), 36u);
  EXPECT_EQ(NoiseDecisionAfter(700), 704u);
  EXPECT_EQ(NoiseDecisionAfter(UINT32_MAX), UINT32_MAX);
  uint32_t count = 0;
  for (uint32_t rank = 0; rank < 1'000'000; ++count) {
    const uint32_t next = NoiseDecisionAfter(rank);
    ASSERT_GT(next, rank);
    if (rank >= 16) {
      EXPECT_LE(next - rank, rank / 8);
    }
    // Rebinned rays are chosen anew at the ranks 64, 256, 1024, ...: no batch may extend beyond
    // one of them.
    for (uint32_t phase = 64; phase < 1'000'000; phase *= 4)
      EXPECT_FALSE(rank < phase && phase < next) << phase;
    rank = next;
  }
  EXPECT_LT(count, 130u);
}

TEST(NoiseRule, NineOfTenReachableElementsAnswer) {
  const LightField field = testing::NoiseField();
  ThreadPool pool(1);
  RenderCamera camera = testing::NoiseFrames()[0];
  camera.pinhole.intrinsics = {60, 60, 80, 40, 0, 160, 80};
  const ReachableElements reachable(ImageIndex(field), camera, {}, {}, {}, pool);
  NoiseMoments moments(160, 80);
  SensorPlate plate(160, 80);
  std::vector<size_t> reached;
  for (size_t i = 0; i < moments.size(); ++i)
    if (const PlateElement at = moments.ElementAt(i); reachable.Holds(at.x, at.y))
      reached.push_back(i);
  ASSERT_GT(reached.size(), 100u);
  ASSERT_LT(reached.size(), moments.size());
  ASSERT_EQ(reached.size() % 10, 0U);
  const auto add = [&](size_t i, int c, uint64_t value) {
    const PlateElement at = moments.ElementAt(i);
    plate.Add(at.x, at.y, c, {value, 1});
    moments.AddImage(i, c, {value, 1});
  };
  EXPECT_TRUE(std::isinf(MeasureNoise(plate, moments, reachable)));
  // The k-th reachable element has noise k + 1 in blue, and less in the other channels.
  for (size_t k = 0; k < reached.size(); ++k)
    for (int c = 0; c < 3; ++c) {
      add(reached[k], c, 2000);
      if (k < reached.size() * 95 / 100) add(reached[k], c, 2000 + (c == 2 ? 2 * (k + 1) : 1));
    }
  const auto expected = static_cast<double>(reached.size() - reached.size() / 10);
  EXPECT_NEAR(MeasureNoise(plate, moments, reachable), expected, 0.5);
  // In more than a tenth of the reachable elements, green has only a single LF image.
  plate = SensorPlate(160, 80);
  moments = NoiseMoments(160, 80);
  for (size_t k = 0; k < reached.size(); ++k)
    for (int c = 0; c < 3; ++c) {
      add(reached[k], c, 7);
      if (c != 1 || k % 8 != 0) add(reached[k], c, 7);
    }
  EXPECT_TRUE(std::isinf(MeasureNoise(plate, moments, reachable)));
  // No element is reachable.
  const ReachableElements none(ImageIndex(field), camera, {5, 5}, {}, {}, pool);
  EXPECT_TRUE(std::isinf(MeasureNoise(plate, moments, none)));
}

// Rays of weight 0 make no element reachable.
TEST(NoiseRule, OnlyRaysThatCountReachElements) {
  const LightField field = testing::NoiseField();
  ThreadPool pool(1);
  const RenderCamera camera = testing::NoiseFrames()[0];
  const auto reachable = [&](const std::function<RayWeights(LfImageId)>& weights) {
    return ReachableElements(ImageIndex(field), camera, {}, {}, {}, pool, weights);
  };
  const size_t all = reachable({}).count();
  EXPECT_GT(all, 0u);
  EXPECT_EQ(reachable([](LfImageId) { return RayWeights(200); }).count(), all);
  EXPECT_EQ(reachable([](LfImageId) { return RayWeights(0); }).count(), 0u);
  const ReachableElements half = reachable([](LfImageId) {
    return RayWeights(WeightBlocks{}, [](int end_x, int, int count, uint8_t* weights) {
      for (int i = 0; i < count; ++i) weights[i] = end_x + kWeightBlock * i > 40 ? 1 : 0;
    });
  });
  EXPECT_GT(half.count(), 0u);
  EXPECT_FALSE(half.Holds(4, 30));
  EXPECT_TRUE(half.Holds(70, 30));
}

}  // namespace
}  // namespace lf
