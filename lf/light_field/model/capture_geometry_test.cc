// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/capture_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lf {
namespace {

LightField Field(const std::vector<RigidTransform>& poses) {
  LightField field;
  field.intrinsics = {{100, 100, 50, 50, 0, 100, 100}};
  for (const RigidTransform& pose : poses) {
    field.cameras.push_back({pose, 0, 1});
    field.image_names.push_back("x");
  }
  return field;
}

// Returns a grid of 12 x 6 cameras with pitches 0.1 and 0.2. They look at `target`, or along +z if
// it is not given.
LightField Grid(std::optional<Vec3> target) {
  std::vector<RigidTransform> poses;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 12; ++column) {
      const Vec3 centre(0.1 * column, 0.2 * row, 0);
      poses.push_back(
          *LookAlong(centre, target ? Vec3(*target - centre) : Vec3(0, 0, 1), {0, -1, 0}));
    }
  return Field(poses);
}

TEST(CaptureGeometry, SpacingIsTheDistanceToTheNearestNeighbour) {
  EXPECT_NEAR(MedianSpacing(Grid({})), 0.1, 1e-12);
  EXPECT_EQ(MedianSpacing(Field({RigidTransform{}})), 0);
  LightField twice = Grid({});
  for (size_t i = 0; i < 72; ++i) {
    twice.cameras.push_back(twice.cameras[i]);
    twice.image_names.push_back("x");
  }
  EXPECT_NEAR(MedianSpacing(twice), 0.1, 1e-12);
  for (size_t i = 0; i < 72; ++i) twice.cameras[i].cam_from_world.translation.x() += 1e-12;
  EXPECT_NEAR(MedianSpacing(twice), 0.1, 1e-11);
  twice.cameras = {twice.cameras[0], twice.cameras[0]};
  EXPECT_EQ(MedianSpacing(twice), 0);
}

TEST(CaptureGeometry, TheMiddleCameraIsInTheMiddle) {
  const uint32_t middle = MiddleCamera(Grid({})).value;
  EXPECT_TRUE(middle / 12 == 2 || middle / 12 == 3) << middle;
  EXPECT_TRUE(middle % 12 == 5 || middle % 12 == 6) << middle;
}

TEST(CaptureGeometry, AxesMeetAtWhatAllCamerasLookAt) {
  const Vec3 target(0.3, 0.2, 2);
  const std::optional<Vec3> point = AxesMeetingPoint(Grid(target));
  ASSERT_TRUE(point);
  EXPECT_NEAR((*point - target).norm(), 0, 1e-9);
}

TEST(CaptureGeometry, AFewStraysDoNotMoveTheMeetingPoint) {
  const Vec3 target(0.3, 0.2, 2);
  LightField field = Grid(target);
  for (int i = 0; i < 4; ++i)
    field.cameras[i * 7].cam_from_world = *LookAlong({0, 0, 0}, {1, 0.3 * i, 0.1}, {0, -1, 0});
  EXPECT_NEAR((*AxesMeetingPoint(field) - target).norm(), 0, 1e-6);
}

TEST(CaptureGeometry, ParallelAndOutwardAxesDoNotMeet) {
  EXPECT_FALSE(AxesMeetingPoint(Grid({})));
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 20; ++i) {
    const Vec3 outward(std::cos(0.3 * i), 0.1, std::sin(0.3 * i));
    poses.push_back(*LookAlong(outward, outward, {0, -1, 0}));
  }
  EXPECT_FALSE(AxesMeetingPoint(Field(poses)));
}

TEST(CaptureGeometry, TheAxesOfARectifiedSlabMeetInItsPlane) {
  LightField field = Grid({});  // centred at (0.55, 0.5, 0)
  field.intrinsics.clear();
  for (size_t i = 0; i < field.size(); ++i) {
    const Vec3 offset = field.cameras[i].cam_from_world.Inverse().translation - Vec3(0.55, 0.5, 0);
    field.cameras[i].intrinsics_index = static_cast<uint32_t>(i);
    field.intrinsics.push_back(
        {100, 100, 50 + 100 * offset.x() / 4, 50 + 100 * offset.y() / 4, 0, 100, 100});
  }
  const std::optional<Vec3> point = AxesMeetingPoint(field);
  ASSERT_TRUE(point);
  EXPECT_LT((*point - Vec3(0.55, 0.5, 4)).norm(), 1e-9);
}

TEST(CaptureGeometry, OutwardAxesAsLinesMeetBehindTheCameras) {
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 20; ++i) {
    const Vec3 outward(std::cos(0.3 * i), 0.1, std::sin(0.3 * i));
    poses.push_back(*LookAlong(outward, outward, {0, -1, 0}));
  }
  ASSERT_TRUE(PointNearestToAxes(Field(poses)));
  EXPECT_LT(PointNearestToAxes(Field(poses))->norm(), 1e-9);
  EXPECT_FALSE(PointNearestToAxes(Grid({})));
}

TEST(CaptureGeometry, ReachFollowsTheShapeOfTheCapture) {
  const LightField field = Grid({});
  const PinholeCamera middle = field.Camera(LfImageId{2 * 12 + 6});
  const Reach reach = CaptureReach(field, middle, 72);
  EXPECT_NEAR(reach.right_w, 0.5, 0.1001);
  EXPECT_NEAR(reach.up_w, 0.5, 0.1001);
}

TEST(CaptureGeometry, RollIsTheAngleToTheDirectionThatIsUpForMost) {
  LightField field;
  for (const double roll_deg : {0.0, 10.0, -10.0, 0.0}) {
    const double roll = RadiansFromDegrees(roll_deg);
    LfCamera camera;
    camera.cam_from_world =
        *LookAlong({0, 0, 0}, {0, -0.5, 1}, {std::sin(roll), std::cos(roll), 0});
    field.cameras.push_back(camera);
  }
  field.intrinsics = {{10, 10, 5, 5, 0, 10, 10}};
  const Vec3 up = MeanUpWorld(field);
  EXPECT_NEAR(up.norm(), 1, 1e-12);
  EXPECT_NEAR(RollOf(field.Camera({0}), up), 0, 1e-9);
  EXPECT_NEAR(RollOf(field.Camera({1}), up), RollOf(field.Camera({2}), up), 1e-9);
  // The cameras look 27 degrees downward, and the roll is therefore a little more than 10 degrees.
  const double expected = std::atan(std::tan(RadiansFromDegrees(10)) / std::cos(std::atan(0.5)));
  EXPECT_NEAR(RollOf(field.Camera({1}), up), expected, RadiansFromDegrees(0.5));
  // A camera that looks along the up direction has no roll.
  EXPECT_EQ(RollOf(field.Camera({0}), field.Camera({0}).ForwardWorld()), 0);
  field.cameras.resize(2);
  field.cameras[1].cam_from_world = *LookAlong({0, 0, 0}, {0, 0.5, 1}, {0, -1, 0});
  EXPECT_LT(MeanUpWorld(field).norm(), 1 + 1e-12);
}

TEST(CaptureGeometry, TheMiddleCameraIsOneThatIsWanted) {
  LightField field;
  for (int i = 0; i < 9; ++i) {
    LfCamera camera;
    camera.cam_from_world.translation = {-0.1 * i, 0, 0};
    field.cameras.push_back(camera);
  }
  EXPECT_EQ(MiddleCamera(field).value, 4u);
  EXPECT_EQ(MiddleCamera(field, [](LfImageId id) { return id.value % 4 == 2; }).value, 2u);
  EXPECT_EQ(MiddleCamera(field, [](LfImageId) { return false; }).value, 4u);
}

}  // namespace
}  // namespace lf
