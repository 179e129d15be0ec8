// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/focus_stack/focus_planes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lf/camera/path/path_yaml.h"

namespace lf {
namespace {

constexpr const char* kPath = R"(
format: lfpath 1
fps: 25
frames: 1
resolution: [80, 60]
camera:
  sensor_width: 0.036
  focal_length: 0.05
  position: [0.1, 0, -0.1]
  look_at: [0.1, 0.02, 1]
  shift: {{horizontal: 0.003, vertical: -0.002}}
lens:
  aperture_diameter: 0.045
  focus_distance: {}
  focus_tilt_deg: {{horizontal: 10, vertical: -5}}
  breathing: {}
)";

CameraPath PathAt(double distance_w, bool breathing) {
  return *ParsePathYaml(fmt::format(kPath, distance_w, breathing), "path.yaml", std::nullopt);
}

TEST(FocusPlanes, AreEvenInInverseDistance) {
  const std::vector<double> distances_w = EvenFocusDistances({0.5, 4}, 8);
  ASSERT_EQ(distances_w.size(), 8u);
  EXPECT_EQ(distances_w.front(), 0.5);
  EXPECT_EQ(distances_w.back(), 4);
  for (size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(1 / distances_w[i], 2 - 1.75 * static_cast<double>(i) / 7, 1e-14);
}

TEST(FocusPlanes, ASingleOneIsInTheMiddle) {
  EXPECT_EQ(EvenFocusDistances({0.5, 1}, 1), std::vector<double>{2 / 3.0});
}

// The render camera is then the same in every bit, so that frames are.
TEST(FocusPlanes, EqualThoseOfAPathThatStatesTheDistance) {
  for (const bool breathing : {false, true})
    for (const double distance_w : {0.07, 0.9, 30.0}) {
      const RenderCamera expected = PathAt(distance_w, breathing).cameras[0];
      const Result<RenderCamera> focused = FocusedAt(PathAt(0.8, breathing).cameras[0], distance_w);
      ASSERT_TRUE(focused);
      EXPECT_EQ(focused->pinhole.intrinsics, expected.pinhole.intrinsics);
      EXPECT_EQ(focused->focus_plane.normal, expected.focus_plane.normal);
      EXPECT_EQ(focused->focus_plane.offset_w, expected.focus_plane.offset_w);
      EXPECT_EQ(focused->focus_distance_w, distance_w);
    }
  EXPECT_NE(PathAt(0.07, true).cameras[0].pinhole.intrinsics,
            PathAt(0.8, true).cameras[0].pinhole.intrinsics);
}

TEST(FocusPlanes, AreExposedAtTheInstantsOfTheFrame) {
  CameraPath path = PathAt(0.8, false);
  path.shutter = {180, 2};
  path.instants = {path.cameras[0], path.cameras[0]};
  path.instants[1].pinhole.cam_from_world.translation.x() += 0.1;
  const auto stack = FocusStackPath(path, FrameId{1}, std::vector<double>{0.5, 2});
  ASSERT_TRUE(stack);
  ASSERT_EQ(stack->Instants(FrameId{2}).size(), 2u);
  for (const RenderCamera& instant : stack->Instants(FrameId{2}))
    EXPECT_EQ(instant.focus_distance_w, 2);
  EXPECT_EQ(stack->Instants(FrameId{2})[1].pinhole.cam_from_world.translation,
            path.instants[1].pinhole.cam_from_world.translation);
}

TEST(FocusPlanes, WithinTheFocalLengthNeedALensThatDoesNotBreathe) {
  EXPECT_TRUE(FocusStackPath(PathAt(0.8, false), FrameId{1}, std::vector<double>{0.04}));
  const auto path = FocusStackPath(PathAt(0.8, true), FrameId{1}, std::vector<double>{1, 0.04});
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().kind, ErrorKind::kInput);
  EXPECT_NE(path.error().message.find("focus distance 0.04"), std::string::npos);
}

TEST(FocusPlanes, AreParsedInWorldUnitsAndMillimetres) {
  constexpr double kUnit_m = 0.01;
  EXPECT_EQ(*ParseFocusDistance("0.4", "{near}", kUnit_m), 0.4);
  EXPECT_DOUBLE_EQ(*ParseFocusDistance("400mm", "{near}", kUnit_m), 40);
  for (const char* wrong : {"", "mm", "0", "-1", "nan", "inf", "1 ", "1m", "2e9", "1e-10"})
    EXPECT_FALSE(ParseFocusDistance(wrong, "{near}", kUnit_m)) << wrong;
  EXPECT_EQ(*ParseFocusDistances("3,20mm\t1", "LIST", kUnit_m), (std::vector<double>{3, 2, 1}));
  EXPECT_EQ(*ParseFocusDistances("# all\n3 # far\r\n\n 2,\n", "FILE", kUnit_m),
            (std::vector<double>{3, 2}));
}

TEST(FocusPlanes, ThatAreWrongAreNamedWithTheirLine) {
  const auto wrong = ParseFocusDistances("1\n2 x\n", "planes.txt", 1);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message.substr(0, 15), "planes.txt:2: x");
  EXPECT_FALSE(ParseFocusDistances(" ,\n# 1\n", "planes.txt", 1));
  std::string many;
  for (size_t i = 0; i <= kMostFocusPlanes; ++i) many += "1,";
  EXPECT_FALSE(ParseFocusDistances(many, "{distances}", 1));
}

// A light field of one LF camera that looks along z, and a scene from 2 to 5 in front of it.
LightField OneCamera() {
  LightField light_field;
  light_field.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100});
  light_field.cameras.emplace_back();
  light_field.image_names = {"image.png"};
  light_field.depth_range = DepthRange{2, 5};
  return light_field;
}

RenderCamera CameraAlong(const Vec3& centre_world, const Vec3& forward_world) {
  RenderCamera camera;
  camera.pinhole.cam_from_world = *LookAlong(centre_world, forward_world, -Vec3::UnitY());
  return camera;
}

TEST(FocusRange, IsMeasuredFromTheRenderCamera) {
  ThreadPool pool(1);
  const auto range = FindFocusRange(OneCamera(), CameraAlong({0.2, 0, -0.5}, Vec3::UnitZ()), pool);
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->near_w, 2.5, 1e-12);
  EXPECT_NEAR(range->far_w, 5.5, 1e-12);
}

// At depth z, the LF camera sees points up to z / 2 beside its axis.
TEST(FocusRange, ContainsTheCornersOfTheViewOfATurnedCamera) {
  ThreadPool pool(1);
  const double angle_rad = RadiansFromDegrees(20);
  const auto range = FindFocusRange(
      OneCamera(), CameraAlong(Vec3::Zero(), {std::sin(angle_rad), 0, std::cos(angle_rad)}), pool);
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->near_w, 2 * std::cos(angle_rad) - 1 * std::sin(angle_rad), 1e-12);
  EXPECT_NEAR(range->far_w, 5 * std::cos(angle_rad) + 2.5 * std::sin(angle_rad), 1e-12);
}

TEST(FocusRange, MustBeInFrontOfTheRenderCamera) {
  ThreadPool pool(1);
  const auto range = FindFocusRange(OneCamera(), CameraAlong(Vec3::Zero(), -Vec3::UnitZ()), pool);
  ASSERT_FALSE(range);
  EXPECT_EQ(range.error().kind, ErrorKind::kInput);
}

}  // namespace
}  // namespace lf
