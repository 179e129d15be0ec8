// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/slab_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/random.h"
#include "lf/rebinning/coverage_map.h"

namespace lf {
namespace {

// Returns frames along a line. Their direction turns by `turn_rad` in total, and their focus
// distance changes from 2 to `last_focus_w`.
std::vector<FrameQueries> Frames(int count, double turn_rad, double last_focus_w) {
  std::vector<FrameQueries> frames;
  for (int i = 0; i < count; ++i) {
    const double t = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
    FrameQueries frame;
    frame.camera.pinhole.intrinsics = {90, 90, 40, 30, 0, 80, 60};
    frame.camera.pinhole.cam_from_world = *LookAlong(
        {0.1 * t, 0.02, -0.05 * t},
        {std::sin(turn_rad * (t - 0.5)), 0.1, std::cos(turn_rad * (t - 0.5))}, {0, -1, 0});
    frame.camera.aperture = {0.02, 0, 0};
    frame.camera.focus_distance_w = 2 + t * (last_focus_w - 2);
    frame.camera.focus_plane =
        FocusPlane(frame.camera.pinhole, frame.camera.focus_distance_w, {0.1 * t, 0});
    frame.sampling = {0.008, 1.0 / 90, Vec3(0.05, 0, 0)};
    frame.points = MakeLensPoints(frame.camera.aperture, 9, 1, 0);
    frame.kernel = {0.004, 0.5};
    frames.push_back(frame);
  }
  return frames;
}

// Returns a ray that the frame queries, or one within its reach.
Ray RandomRay(const FrameQueries& frame, RandomSequence& random) {
  const Intrinsics& k = frame.camera.pinhole.intrinsics;
  const auto focus = FocusPointOfElement(frame.camera, random.Uniform(0, k.width_px),
                                         random.Uniform(0, k.height_px));
  const double reach_w = kReach_sigmas * frame.kernel.sigma_st_w;
  Vec2 on_lens;
  do on_lens = Vec2(random.Uniform(-1, 1), random.Uniform(-1, 1));
  while (on_lens.norm() > 1);
  const Vec3 lens =
      LensPointWorld(frame.camera, (frame.camera.aperture.radius_w + 0.6 * reach_w) * on_lens);
  return {lens, *focus - lens};
}

TEST(SlabPlan, IsAmongTheFramesAndFacesAsTheyDo) {
  const auto frames = Frames(5, 0.2, 2);
  const auto sections = PlanSlabs(frames, {});
  ASSERT_EQ(sections.size(), 1u);
  const Slab& slab = sections[0].slab;
  EXPECT_EQ(sections[0].end, 5u);
  EXPECT_NEAR(slab.st.Normal().dot(Vec3(0, 0.1, 1).normalized()), 1, 1e-3);
  EXPECT_LT((slab.st.origin_world - Vec3(0.05, 0.02, -0.025)).norm(), 0.05);
  EXPECT_NEAR(slab.st.Normal().dot(slab.uv.origin_world - slab.st.origin_world), 2, 0.1);
  EXPECT_LE(slab.r_st_w, 0.002);
  // An LF pixel is as wide as an element.
  EXPECT_NEAR(slab.r_uv_w, 0.25 * 2 / 90, 0.0003);
}

TEST(SlabPlan, HoldsAllRays) {
  for (const double turn : {0.0, 0.6}) {
    const auto frames = Frames(4, turn, 5);
    for (const SlabSection& section : PlanSlabs(frames, {})) {
      RandomSequence random(3);
      for (size_t f = section.begin; f < section.end; ++f)
        for (int i = 0; i < 500; ++i) {
          const auto point = Parameterize(section.slab, RandomRay(frames[f], random));
          ASSERT_TRUE(point);
          EXPECT_TRUE((point->array() >= section.bounds.low.array()).all());
          EXPECT_TRUE((point->array() <= section.bounds.high.array()).all());
          EXPECT_TRUE(CellOf(section.slab, *point));
        }
    }
  }
}

// Within a cell of the st plane, the point in focus moves by less than a cell of the uv plane.
TEST(SlabPlan, CellsAreFineWhereTheFocusIsPulledTo) {
  SlabChoices choices;
  choices.r_uv_w = 0.0005;
  const auto still = PlanSlabs(Frames(3, 0, 2), choices);
  const auto pulled = PlanSlabs(Frames(3, 0, 20), choices);
  ASSERT_EQ(pulled.size(), 1u);
  EXPECT_LT(pulled[0].slab.r_st_w, still[0].slab.r_st_w);
  const Slab& slab = pulled[0].slab;
  const double distance = slab.st.Normal().dot(slab.uv.origin_world - slab.st.origin_world);
  EXPECT_NEAR(1 / distance, (1 / 2.0 + 1 / 20.0) / 2, 0.02);
  for (const double focus : {2.0, 20.0})
    EXPECT_LE(slab.r_st_w * std::abs(distance - focus) / distance,
              1.3 * slab.r_uv_w * focus / distance);
}

TEST(SlabPlan, FramesThatTurnHaveSlabsOfTheirOwn) {
  const auto sections = PlanSlabs(Frames(9, 3, 2), {});
  ASSERT_GT(sections.size(), 2u);
  size_t next = 0;
  const auto frames = Frames(9, 3, 2);
  for (const SlabSection& section : sections) {
    EXPECT_EQ(section.begin, next);
    next = section.end;
    for (size_t f = section.begin; f < section.end; ++f)
      EXPECT_GT(section.slab.st.Normal().dot(frames[f].camera.pinhole.ForwardWorld()), 0.86);
  }
  EXPECT_EQ(next, 9u);
}

TEST(SlabPlan, ChoicesOverride) {
  SlabChoices choices;
  choices.r_st_w = 0.01;
  choices.r_uv_w = 0.02;
  choices.uv_distance_w = 7;
  choices.forward_world = Vec3(0.1, 0, 1);
  const auto sections = PlanSlabs(Frames(2, 0, 2), choices);
  const Slab& slab = sections[0].slab;
  EXPECT_EQ(slab.r_st_w, 0.01);
  EXPECT_EQ(slab.r_uv_w, 0.02);
  EXPECT_NEAR(slab.st.Normal().dot(slab.uv.origin_world - slab.st.origin_world), 7, 1e-9);
  EXPECT_NEAR(slab.st.Normal().dot(Vec3(0.1, 0, 1).normalized()), 1, 1e-12);
}

TEST(CoverageMap, CoversWhatIsAskedForAndNotMuchMore) {
  ThreadPool pool(2);
  const auto frames = Frames(3, 0.3, 4);
  const SlabSection section = PlanSlabs(frames, {})[0];
  for (const size_t bytes : {size_t{1} << 24, size_t{1} << 14}) {
    CoverageOptions options;
    options.most_bytes = bytes;
    const CoverageMap map(section, frames, options, pool);
    EXPECT_LE(map.size_bytes(), bytes);
    RandomSequence random(4);
    for (const FrameQueries& frame : frames)
      for (int i = 0; i < 2000; ++i)
        ASSERT_TRUE(map.Covers(*Parameterize(section.slab, RandomRay(frame, random))));
    EXPECT_LT(map.share(), 0.9);
    EXPECT_FALSE(map.Covers(2 * section.bounds.high));
    // This ray passes the rim of the lens towards the opposite side of the scene: no frame queries
    // it.
    SlabPoint corner = section.bounds.low;
    corner.tail<2>() = section.bounds.high.tail<2>();
    if (bytes > 1 << 20) {
      EXPECT_FALSE(map.Covers(corner));
    }
  }
}

// Only the upper right quarter of the plate queries rays, and only those through the left half of
// the lens.
TEST(CoverageMap, LeavesOutWhatIsNotAskedFor) {
  ThreadPool pool(2);
  auto frames = Frames(1, 0, 2);
  FrameQueries& frame = frames[0];
  frame.points = MakeLensPoints(frame.camera.aperture, 64, 1, 0);
  frame.kernel.sigma_st_w = 0.001;
  const SlabSection section = PlanSlabs(frames, {})[0];
  PointShares shares{NodeAxis(80, 9), NodeAxis(60, 9), 64, {}};
  const int columns = shares.columns.count();
  for (int node = 0; node < static_cast<int>(shares.node_count()); ++node)
    for (const Vec2& point : frame.points.sets[0])
      shares.values.push_back(shares.columns.node_px(node % columns) >= 40 &&
                                      shares.rows.node_px(node / columns) <= 30 && point.x() < 0
                                  ? 1
                                  : 0);
  frame.shares = shares;
  const CoverageMap map(section, frames, {}, pool);
  const auto covers = [&](double x, double y, double lens_x) {
    const Vec3 lens = LensPointWorld(frame.camera, {lens_x, 0});
    return map.Covers(
        *Parameterize(section.slab, Ray{lens, *FocusPointOfElement(frame.camera, x, y) - lens}));
  };
  EXPECT_TRUE(covers(60, 10, -0.01));
  EXPECT_FALSE(covers(60, 10, 0.015));
  EXPECT_FALSE(covers(10, 10, -0.01));
  EXPECT_FALSE(covers(60, 55, -0.01));
  for (float& value : frame.shares->values) value = 0;
  EXPECT_TRUE(CoverageMap(section, frames, {}, pool).is_empty());
}

}  // namespace
}  // namespace lf
