// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/sweep_sums.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lf/analysis/depth/plane_sweep.h"
#include "lf/core/random.h"

namespace lf {
namespace {

// Calls check() once for each instruction set of this machine.
template <class Check>
void ForEachSimdTarget(const Check& check) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    SCOPED_TRACE(hwy::TargetName(target));
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

RenderCamera FrameOf(int width, int height) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {60, 60, width / 2.0, height / 2.0, 0, width, height};
  return frame;
}

// A view with random light, at a random place in the lens, turned by up to `turn_rad`. Some of its
// values are 0 or 65535, so that sums reach their limits.
LensView RandomView(RandomSequence& random, double turn_rad, double masked_share) {
  const auto whole = [&](int least, int most) {
    return static_cast<int>(random.Uniform(least, most + 1));
  };
  LensView view;
  view.of.lens_point = {random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1)};
  const int width = whole(20, 90), height = whole(20, 70);
  view.camera.intrinsics = {
      random.Uniform(40, 90), random.Uniform(40, 90), width / 2.0, height / 2.0, 0, width, height};
  const Vec3 axis(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
  view.camera.cam_from_world.rotation =
      Eigen::AngleAxisd(random.Uniform(-turn_rad, turn_rad), axis.normalized()).toRotationMatrix();
  view.camera.cam_from_world.translation = {random.Uniform(-0.2, 0.2), random.Uniform(-0.2, 0.2),
                                            random.Uniform(-0.3, 0.3)};
  view.rect = {whole(0, 8), whole(0, 8), width - whole(0, 8), height - whole(0, 8)};
  view.light = Image<uint16_t>(view.rect.width(), view.rect.height(), 4);
  for (int y = 0; y < view.light.height(); ++y)
    for (int x = 0; x < view.light.width(); ++x) {
      if (random.Uniform(0, 1) < masked_share) {
        view.any_masked = true;
        continue;
      }
      for (int c = 0; c < 3; ++c)
        view.light.at(x, y, c) = static_cast<uint16_t>(std::clamp(whole(-9000, 75000), 0, 65535));
      view.light.at(x, y, 3) = 1;
    }
  return view;
}

void ExpectSame(const RowSums& sums, const RowSums& expected) {
  for (size_t q = 0; q < kLensQuarters; ++q)
    for (size_t i = 0; i < static_cast<size_t>(sums.element_count()); ++i) {
      ASSERT_EQ(sums.Count(q, i), expected.Count(q, i)) << q << " " << i;
      ASSERT_EQ(sums.Squares(q, i), expected.Squares(q, i)) << q << " " << i;
      for (size_t c = 0; c < 3; ++c)
        ASSERT_EQ(sums.Root(q, i, c), expected.Root(q, i, c)) << q << " " << i;
    }
}

// Rows of all lengths, parts of which are beside the view or behind it, through views that are
// turned and masked in part.
TEST(SweepSums, AllBackEndsAddTheBitsOfTheReference) {
  RandomSequence random(7);
  const RenderCamera frame = FrameOf(96, 64);
  uint64_t seen = 0, unseen = 0;
  for (int scene = 0; scene < 300; ++scene) {
    const double turn_rad = scene % 3 == 0 ? 0 : scene % 3 == 1 ? 0.3 : 3;
    std::vector<LensView> views;
    for (int i = 0; i < 5; ++i)
      views.push_back(RandomView(random, turn_rad, scene % 4 == 0 ? 0.05 : 0));
    const int count = 1 + static_cast<int>(random.Uniform(0, scene % 10 == 0 ? 400 : 80));
    const int x_begin = static_cast<int>(random.Uniform(-20, 60));
    const int y = static_cast<int>(random.Uniform(-5, 70));
    RowSums expected(count);
    std::vector<ViewOfPlane> planes;
    for (const LensView& view : views) planes.emplace_back(view, frame, random.Uniform(0.3, 4));
    for (const ViewOfPlane& plane : planes) AddViewReference(plane, x_begin, y, &expected);
    ForEachSimdTarget([&] {
      RowSums sums(count);
      for (const ViewOfPlane& plane : planes) AddView(plane, x_begin, y, &sums);
      ExpectSame(sums, expected);
      sums.Clear();
      ExpectSame(sums, RowSums(count));
    });
    for (size_t q = 0; q < kLensQuarters; ++q)
      for (size_t i = 0; i < static_cast<size_t>(count); ++i) seen += expected.Count(q, i);
    unseen += 5 * static_cast<uint64_t>(count);
  }
  unseen -= seen;
  EXPECT_GT(seen, 10000u);
  EXPECT_GT(unseen, 10000u);
}

// The sums of as many of the brightest pixels as a sweep may have fit into their integers.
TEST(SweepSums, TheBrightestViewsDoNotOverflow) {
  LensView view;
  view.of.lens_point = {0.1, 0.1};
  view.camera.intrinsics = {60, 60, 16, 16, 0, 32, 32};
  view.rect = {0, 0, 32, 32};
  view.light = Image<uint16_t>(32, 32, 4, 65535);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) view.light.at(x, y, 3) = 1;
  const ViewOfPlane plane(view, FrameOf(32, 32), 1.37);
  ForEachSimdTarget([&] {
    RowSums sums(9);
    for (size_t i = 0; i < kMostSweptViews; ++i) AddView(plane, 8, 15, &sums);
    for (size_t i = 0; i < 9; ++i) {
      EXPECT_EQ(sums.Count(3, i), kMostSweptViews);
      EXPECT_EQ(sums.Root(3, i, 1), kMostSweptViews * 65535);
      EXPECT_EQ(sums.Squares(3, i), kMostSweptViews * 3 * 65535 * 65535);
      EXPECT_EQ(sums.Count(0, i), 0u);
    }
  });
}

TEST(SweepSums, DepthsAreTheSameOnAllBackEnds) {
  RandomSequence random(11);
  std::vector<LensView> views;
  for (int i = 0; i < 12; ++i) views.push_back(RandomView(random, 0.05, i == 0 ? 0.02 : 0));
  SweepOptions options;
  for (int i = 0; i < 9; ++i) options.distances_w.push_back(1 / (2 - 0.2 * i));
  std::vector<SweptDepth> expected;
  ForEachSimdTarget([&] {
    std::vector<SweptDepth> depths;
    SweepTile(views, FrameOf(64, 48), options, {8, 8, 51, 40}, &depths);
    if (expected.empty()) expected = depths;
    size_t known = 0;
    for (size_t i = 0; i < depths.size(); ++i) {
      ASSERT_EQ(depths[i].index, expected[i].index);
      ASSERT_EQ(depths[i].confidence, expected[i].confidence);
      ASSERT_EQ(depths[i].roots, expected[i].roots);
      known += depths[i].index >= 0 ? 1 : 0;
    }
    EXPECT_GT(known, depths.size() / 2);
  });
}

}  // namespace
}  // namespace lf
