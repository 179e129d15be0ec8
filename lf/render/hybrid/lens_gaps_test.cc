// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/lens_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/render/hybrid/test_grid.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {
namespace {

using testing::Frame;
using testing::Grid;

LensGaps GapsOf(const LightField& field, const RenderCamera& frame, const RankRange& ranks = {}) {
  ThreadPool pool(2);
  return LensGaps(
      ImageIndex(field, 1), frame, [](LfImageId) { return RayWeights(1); }, true, ranks, {}, {},
      pool);
}

double AskedShare(const FrameQueries& queries) {
  const auto& values = queries.shares->values;
  return std::count(values.begin(), values.end(), 1.0F) / static_cast<double>(values.size());
}

TEST(LensGaps, ALensThatIsFullOfCamerasHasNone) {
  const LensGaps gaps = GapsOf(Grid(), Frame(0.03));
  EXPECT_TRUE(gaps.can_be_asked());
  EXPECT_NEAR(gaps.sampling().lf.camera_distance_w, 0.01, 0.002);
  EXPECT_FALSE(gaps.AsksAt(LensGaps::kInTheEnd));
  EXPECT_FALSE(gaps.QueriesAt(LensGaps::kInTheEnd).AsksForAny());
}

TEST(LensGaps, NothingIsCollectedBeforeTheFirstImageAndLessIsMissingWithEach) {
  const LensGaps gaps = GapsOf(Grid(), Frame(0.03));
  EXPECT_EQ(AskedShare(gaps.QueriesAt(0)), 1);
  double before = 1;
  for (const uint32_t rank : {8u, 32u, 64u, 128u, 144u}) {
    const double now = AskedShare(gaps.QueriesAt(rank));
    EXPECT_LE(now, before);
    before = now;
  }
  EXPECT_EQ(before, 0);
  EXPECT_LE(gaps.changes_until(), 144u);
  EXPECT_FALSE(gaps.AsksAt(gaps.changes_until()));
}

// The lens extends beyond the rows of LF cameras: gaps are above and below the rows, and nowhere
// else.
TEST(LensGaps, ALensLargerThanTheBandIsNoticedBySectors) {
  const LensGaps gaps = GapsOf(Grid(4), Frame(0.06));
  const FrameQueries queries = gaps.QueriesAt(LensGaps::kInTheEnd);
  ASSERT_TRUE(queries.shares);
  const auto& points = queries.points.sets[0];
  int missing = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double outside = std::abs(points[i].y()) - 0.015;
    const float share = queries.shares->values[i];
    missing += share > 0 ? 1 : 0;
    if (outside < 0.01 || outside > 0.025) {
      EXPECT_EQ(share, outside > 0.015 ? 1 : 0) << points[i].transpose();
    }
  }
  EXPECT_GE(missing, 2);
  // The kernels of lens points far from LF cameras are wide enough to reach LF cameras.
  EXPECT_GT(queries.points.MostSpread(), 1.3);
}

TEST(LensGaps, ASmallLensBetweenCamerasAsksForEverything) {
  const LensGaps between = GapsOf(Grid(), Frame(0.00125));
  EXPECT_EQ(AskedShare(between.QueriesAt(LensGaps::kInTheEnd)), 1);
  const LensGaps at_a_camera = GapsOf(Grid(), Frame(0.00125, 0.005));
  EXPECT_EQ(AskedShare(at_a_camera.QueriesAt(LensGaps::kInTheEnd)), 1);
  RenderCamera there = Frame(0.00125, 0.005);
  there.pinhole.cam_from_world = *LookAlong({0.005, 0.005, 0}, {0, 0, 1}, {0, -1, 0});
  there.focus_plane = FocusPlane(there.pinhole, 1, {});
  EXPECT_FALSE(GapsOf(Grid(), there).AsksAt(LensGaps::kInTheEnd));
}

// If the lens is outside the plane of the LF cameras, elements see different LF cameras. Through a
// small lens, some elements see an LF camera and others see none.
TEST(LensGaps, GapsAreDifferentAllOverThePlate) {
  const LensGaps gaps = GapsOf(Grid(), Frame(0.003, 0, -0.3));
  const double share = AskedShare(gaps.QueriesAt(LensGaps::kInTheEnd));
  EXPECT_GT(share, 0.05);
  EXPECT_LT(share, 0.95);
}

// A lens with a radius of three camera distances contains 32 LF cameras. All of them see the plate,
// and all are counted.
TEST(LensGaps, KnowsWhatIsCollectedAndWhen) {
  const LightField field = Grid();
  const LensGaps gaps = GapsOf(field, Frame(0.03));
  size_t inside = 0;
  for (const LfCamera& camera : field.cameras)
    inside += camera.cam_from_world.Inverse().translation.norm() <= 0.03 ? 1 : 0;
  EXPECT_EQ(gaps.collected_count(), inside);
  EXPECT_EQ(gaps.RankAfter(0), 0u);
  uint32_t before = 0;
  for (size_t count = 1; count <= inside; ++count) {
    const uint32_t rank = gaps.RankAfter(count);
    EXPECT_GT(rank, before);
    before = rank;
  }
  EXPECT_EQ(gaps.RankAfter(1000), before);
  EXPECT_LE(before, 144u);
}

// If LF images end close to a side of the plate, only the elements at that side need rebinned rays.
TEST(LensGaps, ElementsAtARimAskAlone) {
  RenderCamera frame = Frame(0.03);
  // LF images are 64 pixels wide at a focal length of 70 pixels: they end at the tangent 0.457 (32
  // / 70). The plate ends at 0.47.
  frame.pinhole.intrinsics = {80 / 0.47 / 2, 80 / 0.47 / 2, 40, 30, 0, 80, 60};
  const FrameQueries queries = GapsOf(Grid(), frame).QueriesAt(LensGaps::kInTheEnd);
  const auto asks = [&](int x, int y) {
    return queries.shares->IsAny({x, y, x + 1, y + 1}, 0, queries.points.point_count());
  };
  EXPECT_TRUE(asks(0, 30));
  EXPECT_TRUE(asks(79, 30));
  EXPECT_FALSE(asks(8, 30));
  EXPECT_FALSE(asks(71, 30));
}

TEST(LensGaps, WhatTheFrameDoesNotTakeCoversNothing) {
  const LensGaps gaps = GapsOf(Grid(), Frame(0.03), {0, 10});
  EXPECT_TRUE(gaps.AsksAt(LensGaps::kInTheEnd));
  EXPECT_LE(gaps.changes_until(), 10u);
}

TEST(LensGaps, WithoutCollectionEverythingIsAskedForAndAPinholeHasOnePoint) {
  ThreadPool pool(1);
  const LightField field = Grid();
  const LensGaps gaps(ImageIndex(field), Frame(0), {}, false, {}, {}, {}, pool);
  EXPECT_TRUE(gaps.AsksAt(LensGaps::kInTheEnd));
  EXPECT_FALSE(gaps.QueriesAt(0).shares);
  EXPECT_EQ(gaps.QueriesAt(0).points.point_count(), 1u);
  EXPECT_EQ(gaps.changes_until(), 0u);
  EXPECT_GT(gaps.ReachedCamera().aperture.radius_w, 0.01);
}

TEST(LensGaps, WithoutCamerasNobodyCanBeAsked) {
  ThreadPool pool(1);
  LightField field = Grid();
  field.cameras.clear();
  field.image_names.clear();
  const LensGaps gaps(ImageIndex(field), Frame(0.01), {}, false, {}, {}, {}, pool);
  EXPECT_FALSE(gaps.can_be_asked());
  EXPECT_FALSE(gaps.AsksAt(0));
}

}  // namespace
}  // namespace lf
