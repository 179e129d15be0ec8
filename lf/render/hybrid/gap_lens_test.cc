// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/gap_lens.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/render/hybrid/test_grid.h"

namespace lf {
namespace {

using testing::Frame;
using testing::Grid;

struct Gap {
  Gap(LightField of, const RenderCamera& frame, LensWeights weights, const RankRange& taken = {})
      : field(std::move(of)),
        index(field, 1),
        lens(index, frame, weights, {}, pool),
        gap(index, frame, lens, taken, {}, pool) {}

  double SumAt(int x, int y) const {
    double sum = 0;
    for (const LfImageId id : gap.images()) sum += gap.WeightsOf(id).At(x, y);
    return sum;
  }

  LightField field;
  ThreadPool pool{2};
  ImageIndex index;
  FrameLens lens;
  GapLens gap;
};

TEST(GapLens, ALensThatIsFullOfCollectedRaysHasNone) {
  for (const LensWeights weights : {LensWeights::kNone, LensWeights::kAuto}) {
    const Gap full(Grid(), Frame(0.03), weights);
    EXPECT_FALSE(full.gap.exists());
    EXPECT_TRUE(full.gap.images().empty());
  }
}

TEST(GapLens, APinholeBetweenCamerasIsCompletedByItsNeighbours) {
  const Gap pinhole(Grid(), Frame(0, 0.002, 0, 0.003), LensWeights::kNone);
  ASSERT_TRUE(pinhole.gap.exists());
  EXPECT_EQ(pinhole.gap.ShareAt(40, 30), 1);
  // The weights are those of the hats, by which such a frame is collected.
  const Gap hats(Grid(), Frame(0, 0.002, 0, 0.003), LensWeights::kHat);
  EXPECT_FALSE(hats.gap.exists());
  double sum = 0;
  for (const LfImageId id : hats.lens.near()) sum += hats.lens.WeightsOf(id).At(40, 30);
  for (const LfImageId id : hats.lens.near())
    EXPECT_NEAR(pinhole.gap.WeightsOf(id).At(40, 30) / pinhole.SumAt(40, 30),
                hats.lens.WeightsOf(id).At(40, 30) / sum, 0.01);
}

// Its rays are hats, which stand for all of the lens, although it is beyond the outermost row.
TEST(GapLens, ASmallLensBeyondTheCaptureHasNone) {
  const RenderCamera beyond = Frame(0.002, 0, 0, 0.0635);
  EXPECT_FALSE(Gap(Grid(), beyond, LensWeights::kHat).gap.exists());
  EXPECT_FALSE(Gap(Grid(), beyond, LensWeights::kAuto).gap.exists());
  EXPECT_TRUE(Gap(Grid(), beyond, LensWeights::kNone).gap.exists());
}

// The lens reaches 0.01 beyond the outermost rows, and more beyond their rays.
TEST(GapLens, ALensHigherThanTheCaptureIsCompletedByItsEdges) {
  for (const LensWeights weights : {LensWeights::kNone, LensWeights::kAuto}) {
    const Gap high(Grid(4), Frame(0.05), weights);
    ASSERT_TRUE(high.gap.exists());
    const double share = high.gap.ShareAt(40, 30);
    // The part of the disk that is more than half a camera distance above or below the rows.
    const double covered = std::asin(0.02 / 0.05) + 0.4 * std::sqrt(1 - 0.16);
    EXPECT_NEAR(share, 1 - 2 / kPi * covered, 0.03);
    EXPECT_NEAR(high.SumAt(40, 30) / high.gap.WeightsPerShare(), share, 0.03);
    // The two rows at the edges take nearly all of it.
    double edges = 0;
    for (const LfImageId id : high.gap.images())
      if (id.value < 12 || id.value >= 36) edges += high.gap.WeightsOf(id).At(40, 30);
    EXPECT_GT(edges / high.SumAt(40, 30), 0.9);
  }
}

// No step of a film shows: a lens grows by less than 1 % from frame to frame.
TEST(GapLens, TheGapGrowsSmoothlyWithTheLens) {
  for (const LensWeights weights : {LensWeights::kNone, LensWeights::kAuto}) {
    double before = 0;
    for (double radius_w = 0.018; radius_w < 0.05; radius_w *= 1.009) {
      const Gap high(Grid(4), Frame(radius_w), weights);
      const double share = high.gap.exists() ? high.gap.ShareAt(40, 30) : 0;
      EXPECT_GE(share, before - 0.003) << radius_w;
      EXPECT_LE(share, before + 0.025) << radius_w;
      before = share;
    }
    EXPECT_GT(before, 0.4);
  }
}

// LF images that the frame does not take complete nothing.
TEST(GapLens, LfImagesThatAreNotTakenCompleteNothing) {
  const Gap limited(Grid(), Frame(0, 0.002, 0, 0.003), LensWeights::kNone, {0, 20});
  ASSERT_TRUE(limited.gap.exists());
  EXPECT_FALSE(limited.gap.images().empty());
  for (const LfImageId id : limited.gap.images()) EXPECT_LT(limited.index.RankOf(id), 20u);
}

TEST(GapLens, WhatTheHoodCutsOffIsNoGap) {
  RenderCamera frame = Frame(0.05);
  const Gap open(Grid(4), frame, LensWeights::kAuto);
  frame.hood = {0.1, 0.03};
  const Gap hooded(Grid(4), frame, LensWeights::kAuto);
  ASSERT_TRUE(open.gap.exists());
  ASSERT_TRUE(hooded.gap.exists());
  // In the middle, the hood cuts off all around the lens, where the gap is.
  EXPECT_LT(hooded.gap.ShareAt(40, 30), 0.7 * open.gap.ShareAt(40, 30));
}

TEST(GapLens, ElementsAreThoseWithWeights) {
  const Gap high(Grid(4), Frame(0.05), LensWeights::kAuto);
  for (const LfImageId id : high.gap.images()) {
    const PixelRect window = *high.gap.CameraOf(id).window;
    const RayWeights weights = high.gap.WeightsOf(id);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x)
        ASSERT_TRUE(weights.At(x, y) == 0 || window.Contains(x, y)) << x << " " << y;
  }
}

}  // namespace
}  // namespace lf
