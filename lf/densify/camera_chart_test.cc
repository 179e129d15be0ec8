// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/camera_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lf/densify/test_world.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

LightField FieldOf(const std::vector<PinholeCamera>& cameras) {
  LightField field;
  field.intrinsics = {cameras.front().intrinsics};
  for (const PinholeCamera& camera : cameras) {
    LfCamera of_field;
    of_field.cam_from_world = camera.cam_from_world;
    field.cameras.push_back(of_field);
    field.image_names.emplace_back();
  }
  return field;
}

// Returns cameras on a circle of radius 1 around the origin, which look at it.
LightField Ring(int count) {
  std::vector<PinholeCamera> cameras;
  for (int i = 0; i < count; ++i) {
    const double turn = 2 * kPi * i / count;
    PinholeCamera camera = CameraAt(0, 0);
    camera.cam_from_world = *LookAlong(Vec3(std::sin(turn), 0, -std::cos(turn)),
                                       Vec3(-std::sin(turn), 0, std::cos(turn)), -Vec3::UnitY());
    cameras.push_back(camera);
  }
  return FieldOf(cameras);
}

TEST(CompareWith, ChoosesTheEightAroundAPointOfAGrid) {
  std::vector<PinholeCamera> cameras;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) cameras.push_back(CameraAt(x, y));
  const std::vector<std::vector<uint32_t>> chosen =
      CompareWith(FieldOf(cameras), FarEnoughApart(FieldOf(cameras), {}), {});
  std::vector<uint32_t> middle = chosen[12];
  std::sort(middle.begin(), middle.end());
  EXPECT_EQ(middle, (std::vector<uint32_t>{6, 7, 8, 11, 13, 16, 17, 18}));
  EXPECT_GE(chosen[0].size(), 3u);
  for (uint32_t id = 0; id < chosen.size(); ++id)
    EXPECT_EQ(std::count(chosen[id].begin(), chosen[id].end(), id), 0);
}

TEST(CompareWith, AroundAnObjectNeighboursAreThoseOfEachSide) {
  const LightField ring = Ring(36);
  const std::optional<Vec3> subject = AxesMeetingPoint(ring);
  ASSERT_TRUE(subject);
  const std::vector<std::vector<uint32_t>> chosen =
      CompareWith(ring, FarEnoughApart(ring, {}), subject);
  for (uint32_t id = 0; id < 36; ++id) {
    std::vector<uint32_t> steps;
    for (const uint32_t other : chosen[id])
      steps.push_back(std::min((other + 36 - id) % 36, (id + 36 - other) % 36));
    std::sort(steps.begin(), steps.end());
    EXPECT_EQ(steps, (std::vector<uint32_t>{1, 1, 2, 2}));
  }
}

TEST(CompareWith, FarNeighboursAreTheNearestTwoAlone) {
  const LightField ring = Ring(12);
  for (const std::vector<uint32_t>& chosen :
       CompareWith(ring, FarEnoughApart(ring, {}), AxesMeetingPoint(ring)))
    EXPECT_EQ(chosen.size(), 2u);
}

TEST(CompareWith, LfCamerasAtOnePlaceHaveNoNeighbours) {
  const LightField field = FieldOf({CameraAt(0, 0), CameraAt(0, 0)});
  for (const std::vector<uint32_t>& chosen : CompareWith(field, FarEnoughApart(field, {}), {}))
    EXPECT_TRUE(chosen.empty());
}

TEST(CompareWith, WithoutOthersOnItsSideAnLfCameraHasTheNearestTwo) {
  const LightField ring = Ring(4);
  const std::vector<std::vector<uint32_t>> chosen =
      CompareWith(ring, FarEnoughApart(ring, {}), AxesMeetingPoint(ring));
  EXPECT_EQ(chosen[0], (std::vector<uint32_t>{1, 3}));
}

TEST(FarEnoughApart, LeavesOutWhatIsNearToOthers) {
  const LightField ring = Ring(1000);
  const std::vector<uint32_t> ids = FarEnoughApart(ring, Vec3::Zero());
  const auto apart_deg = [&](uint32_t a, uint32_t b) {
    return DegreesFromRadians(std::acos(std::clamp(
        ring.Camera(LfImageId{a}).CentreWorld().dot(ring.Camera(LfImageId{b}).CentreWorld()), -1.0,
        1.0)));
  };
  for (size_t i = 1; i < ids.size(); ++i)
    EXPECT_GE(apart_deg(ids[i - 1], ids[i]), kLeastApart_deg - 1e-9);
  for (uint32_t id = 0; id < ring.size(); ++id)
    EXPECT_TRUE(std::any_of(ids.begin(), ids.end(), [&](uint32_t other) {
      return apart_deg(id, other) <= kLeastApart_deg;
    })) << id;
  // LF cameras that are left out are compared with others.
  const auto chosen = CompareWith(ring, ids, Vec3::Zero());
  for (uint32_t id = 0; id < ring.size(); ++id) {
    EXPECT_GE(chosen[id].size(), 4u) << id;
    for (const uint32_t other : chosen[id])
      EXPECT_TRUE(std::binary_search(ids.begin(), ids.end(), other)) << id;
  }
  EXPECT_EQ(FarEnoughApart(ring, {}).size(), ring.size());
}

TEST(ChartAround, ShowsTheSideThatLooksAtThePoint) {
  const LightField ring = Ring(35);
  const PinholeCamera camera = ring.Camera(LfImageId{0});
  const CameraChart chart = ChartAround(ring, FarEnoughApart(ring, {}), camera, 1);
  // It has the LF cameras at most 60 degrees away.
  ASSERT_EQ(chart.ids.size(), 11u);
  EXPECT_EQ(chart.ids[0], 0u);
  EXPECT_NEAR(chart.points[0].norm(), 0, 1e-12);
  // All of them lie on the lines through the origin, so that the chart has the tangents.
  for (size_t i = 0; i < chart.ids.size(); ++i) {
    const double turn = 2 * kPi * chart.ids[i] / 35;
    EXPECT_NEAR(chart.points[i].x(), std::tan(turn), 1e-9);
    EXPECT_NEAR(chart.points[i].y(), 0, 1e-9);
  }
}

TEST(ChartAround, OfAPlaneLookingFarAwayIsThePlane) {
  std::vector<PinholeCamera> cameras;
  for (int x = 0; x < 4; ++x) cameras.push_back(CameraAt(x, 0.5 * x));
  const CameraChart chart =
      ChartAround(FieldOf(cameras), FarEnoughApart(FieldOf(cameras), {}), CameraAt(1, 1), 0);
  ASSERT_EQ(chart.points.size(), 4u);
  for (int x = 0; x < 4; ++x)
    EXPECT_NEAR((chart.points[static_cast<size_t>(x)] - Vec2(x - 1, 0.5 * x - 1)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace lf
