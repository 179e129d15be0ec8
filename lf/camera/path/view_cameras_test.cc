// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/view_cameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lf/camera/path/test_path.h"

namespace lf {
namespace {

// Returns a path whose camera turns, rolls and moves, with a plate that is shifted.
CameraPath LivelyPath(const std::string& more_optics = "") {
  TestPath path;
  path.pose =
      "position: [0.1, 0.2, -2], speed: [0.3, 0, 0.1], look_at: [0, 0.1, 0], roll_deg: 17, "
      "shift_mm: {horizontal: 3, vertical: -2}" +
      more_optics;
  path.focus = "focus_distance: 2, focus_distance_speed: 0.5";
  const auto parsed = path.Parse();
  EXPECT_TRUE(parsed) << parsed.error().message;
  return *parsed;
}

// Returns a point at x, y on the plane of depth z in front of a camera.
Vec3 PointAt(const RenderCamera& camera, double x, double y, double z) {
  return camera.pinhole.cam_from_world.Inverse() * Vec3(x, y, z);
}

Vec2 Seen(const RenderCamera& camera, const Vec3& point) {
  const auto position = Project(camera.pinhole, point);
  EXPECT_TRUE(position);
  return position.value_or(Vec2(0, 0));
}

TEST(ViewCameras, PointsOfTheConvergencePlaneHaveOnePositionInAllViews) {
  const CameraPath path = LivelyPath();
  const auto views = QuiltPath(path, 5, RadiansFromDegrees(40), 1.5);
  ASSERT_TRUE(views);
  ASSERT_EQ(views->frame_count(), 5 * path.frame_count());
  EXPECT_EQ(views->views, 5);
  EXPECT_EQ(views->moment_count(), path.frame_count());
  for (size_t i = 0; i < views->frame_count(); ++i) {
    const RenderCamera& camera = path.cameras[i / 5];
    for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(-0.4, 0.2), std::pair(0.3, 0.7)}) {
      const Vec3 point = PointAt(camera, x, y, 1.5);
      EXPECT_LE((Seen(views->cameras[i], point) - Seen(camera, point)).norm(), 1e-10);
    }
  }
}

TEST(ViewCameras, DisparityIsBaselineTimesFocalLengthTimesDifferenceOfInverseDepths) {
  const CameraPath path = LivelyPath();
  constexpr double kSeparation = 0.065, kConvergence = 1.5;
  const auto views = StereoPath(path, kSeparation, kConvergence);
  ASSERT_TRUE(views);
  for (size_t frame = 0; frame < path.frame_count(); ++frame)
    for (const double z : {0.4, 1.0, 1.5, 3.0, 1e6}) {
      const RenderCamera& camera = path.cameras[frame];
      const Vec3 point = PointAt(camera, 0.1 * z, -0.2 * z, z);
      const Vec2 disparity =
          Seen(views->cameras[2 * frame + 1], point) - Seen(views->cameras[2 * frame], point);
      const double fx = camera.pinhole.intrinsics.fx_px;
      EXPECT_NEAR(disparity.x(), kSeparation * fx * (1 / kConvergence - 1 / z), 1e-9) << z;
      EXPECT_NEAR(disparity.y(), 0, 1e-9);
    }
}

TEST(ViewCameras, TheLeftEyeComesFirstAndHalfTheSeparationAway) {
  const CameraPath path = LivelyPath();
  const auto views = StereoPath(path, 0.065, std::nullopt);
  ASSERT_TRUE(views);
  for (size_t frame = 0; frame < path.frame_count(); ++frame)
    for (const int view : {0, 1}) {
      const RenderCamera& camera = path.cameras[frame];
      const RenderCamera& eye = views->cameras[2 * frame + static_cast<size_t>(view)];
      const Vec3 moved = eye.pinhole.CentreWorld() - camera.pinhole.CentreWorld();
      EXPECT_LE((moved - (view - 0.5) * 0.065 * camera.pinhole.RightWorld()).norm(), 1e-12);
      // Parallel: the axes are those of the frame, to the bit.
      EXPECT_EQ(eye.pinhole.cam_from_world.rotation, camera.pinhole.cam_from_world.rotation);
    }
}

TEST(ViewCameras, ViewsFillTheAngleEvenlyFromTheLeft) {
  const CameraPath path = LivelyPath();
  const auto views = QuiltPath(path, 4, RadiansFromDegrees(35), std::nullopt);
  ASSERT_TRUE(views);
  for (size_t frame = 0; frame < path.frame_count(); ++frame) {
    const RenderCamera& camera = path.cameras[frame];
    // The default distance of convergence is the focus distance of the frame, which moves.
    const double most = camera.focus_distance_w * std::tan(RadiansFromDegrees(17.5));
    for (int view = 0; view < 4; ++view) {
      const Vec3 moved =
          views->cameras[4 * frame + static_cast<size_t>(view)].pinhole.CentreWorld() -
          camera.pinhole.CentreWorld();
      EXPECT_NEAR(moved.dot(camera.pinhole.RightWorld()), (-1 + 2 * view / 3.0) * most, 1e-12);
    }
  }
  EXPECT_NE(path.cameras.front().focus_distance_w, path.cameras.back().focus_distance_w);
}

TEST(ViewCameras, ConvergenceAtTheFocusPutsSharpPointsAtOnePosition) {
  const CameraPath path = LivelyPath();
  const auto views = StereoPath(path, 0.1, std::nullopt);
  ASSERT_TRUE(views);
  for (size_t frame = 0; frame < path.frame_count(); ++frame) {
    const RenderCamera& left = views->cameras[2 * frame];
    const auto point = FocusPointOfElement(left, 60, 30);
    ASSERT_TRUE(point);
    EXPECT_LE((Seen(views->cameras[2 * frame + 1], *point) - Vec2(60, 30)).norm(), 1e-9);
  }
}

TEST(ViewCameras, ATiltedFocusPlaneIsOnePlaneOfTheWorld) {
  TestPath path;
  path.focus = "focus_distance: 2, focus_tilt_deg: {horizontal: 30, vertical: 10}";
  const auto parsed = path.Parse();
  ASSERT_TRUE(parsed);
  const auto views = StereoPath(*parsed, 0.5, 1.2);
  ASSERT_TRUE(views);
  for (const RenderCamera& eye : views->cameras) {
    const Plane& plane = parsed->cameras[0].focus_plane;
    EXPECT_LE((eye.focus_plane.normal - plane.normal).norm(), 1e-12);
    EXPECT_NEAR(eye.focus_plane.offset_w, plane.offset_w, 1e-12);
  }
  EXPECT_NEAR(views->cameras[1].focus_distance_w, 2 + 0.25 * std::tan(kPi / 6), 1e-12);
}

TEST(ViewCameras, AFocusPlaneBehindAViewIsAnError) {
  TestPath path;
  path.focus = "focus_distance: 0.1, focus_tilt_deg: {horizontal: 60}";
  const auto parsed = path.Parse();
  ASSERT_TRUE(parsed);
  const auto views = StereoPath(*parsed, 0.2, 1);
  ASSERT_FALSE(views);
  EXPECT_EQ(views.error().kind, ErrorKind::kInput);
  EXPECT_EQ(views.error().message.find("frame 1, view 1: the camera is moved aside by -0.1"), 0u)
      << views.error().message;
}

TEST(ViewCameras, TooManyCamerasAreAnError) {
  CameraPath path = LivelyPath();
  path.cameras.resize(600'000, path.cameras[0]);
  const auto views = StereoPath(path, 0.065, std::nullopt);
  ASSERT_FALSE(views);
  EXPECT_NE(views.error().message.find("1200000 cameras: expected at most 1000000"),
            std::string::npos);
}

TEST(ViewCameras, AShutterIsAnError) {
  CameraPath path = LivelyPath();
  path.shutter = {180, 4};
  const auto views = StereoPath(path, 0.065, std::nullopt);
  ASSERT_FALSE(views);
  EXPECT_NE(views.error().message.find("remove the shutter"), std::string::npos);
}

TEST(ViewCameras, TimesCountTheCamerasOfThePath) {
  const CameraPath path = LivelyPath();
  const auto views = StereoPath(path, 0.065, std::nullopt);
  ASSERT_TRUE(views);
  EXPECT_EQ(views->fps, path.fps);
  for (size_t i = 0; i < views->frame_count(); ++i)
    EXPECT_DOUBLE_EQ(views->cameras[i].time_s, static_cast<double>(i) / path.fps);
}

TEST(ViewCameras, APathOfViewsHasNoViewsOfItsOwn) {
  const auto views = StereoPath(LivelyPath(), 0.065, std::nullopt);
  ASSERT_TRUE(views);
  const auto again = StereoPath(*views, 0.065, std::nullopt);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("2 views of each moment already"), std::string::npos);
}

}  // namespace
}  // namespace lf
