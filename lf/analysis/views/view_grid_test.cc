// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/views/view_grid.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

// LF cameras in `columns` x `rows`, 0.5 apart along the axes of a camera that is turned in the
// world. The principal points move by `principal_px_per_w`.
LightField Capture(int columns, int rows, double principal_px_per_w = 0) {
  const Mat3 rotation = Eigen::AngleAxisd(0.7, Vec3(0.2, 1, 0.3).normalized()).toRotationMatrix();
  LightField light_field;
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u) {
      const Vec2 at_w(0.5 * u, 0.5 * v);
      LfCamera camera;
      camera.cam_from_world = {rotation, Vec3(-at_w.x(), -at_w.y(), 2)};
      camera.intrinsics_index = static_cast<uint32_t>(light_field.intrinsics.size());
      light_field.cameras.push_back(camera);
      light_field.intrinsics.push_back({100, 101, 32 + principal_px_per_w * at_w.x(),
                                        24 + principal_px_per_w * at_w.y(), 0, 64, 48});
      light_field.image_names.push_back(std::to_string(v) + "_" + std::to_string(u) + ".png");
    }
  return light_field;
}

void ExpectSame(const PinholeCamera& view, const PinholeCamera& lf_camera) {
  EXPECT_NEAR((view.cam_from_world.rotation - lf_camera.cam_from_world.rotation).norm(), 0, 1e-12);
  EXPECT_NEAR((view.CentreWorld() - lf_camera.CentreWorld()).norm(), 0, 1e-12);
  EXPECT_NEAR((view.intrinsics.Matrix() - lf_camera.intrinsics.Matrix()).norm(), 0, 1e-9);
}

TEST(ViewGrid, OfARegularCaptureHasItsLfCameras) {
  for (const double principal_px_per_w : {0.0, 3.5}) {
    const LightField capture = Capture(5, 3, principal_px_per_w);
    const auto grid = ViewGrid::Make(capture, 5, 3);
    ASSERT_TRUE(grid);
    for (uint32_t view = 0; view < 15; ++view) {
      ASSERT_TRUE(grid->RecordedAt(view));
      EXPECT_EQ(grid->RecordedAt(view)->value, view);
      ExpectSame(grid->Camera(view), capture.Camera(LfImageId{view}));
    }
    EXPECT_NEAR((grid->step_w() - Vec2(0.5, 0.5)).norm(), 0, 1e-12);
  }
}

TEST(ViewGrid, IsEvenlySpreadOverTheCapture) {
  const LightField capture = Capture(5, 3);
  const auto grid = ViewGrid::Make(capture, 4, 2);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->step_w().x(), 2.0 / 3, 1e-12);
  EXPECT_NEAR(grid->step_w().y(), 1, 1e-12);
  for (size_t view = 0; view < grid->size(); ++view) {
    const bool is_corner = grid->column_of(view) == 0 || grid->column_of(view) == 3;
    EXPECT_EQ(grid->RecordedAt(view).has_value(), is_corner) << view;
  }
  EXPECT_EQ(grid->RecordedAt(7)->value, 14u);
  EXPECT_NEAR((grid->Position_w(0) - Vec2(-1, -0.5)).norm(), 0, 1e-12);
}

TEST(ViewGrid, OfOneViewIsInTheMiddle) {
  const auto grid = ViewGrid::Make(Capture(5, 3), 1, 1);
  ASSERT_TRUE(grid);
  ASSERT_TRUE(grid->RecordedAt(0));
  EXPECT_EQ(grid->RecordedAt(0)->value, 7u);
  const auto row = ViewGrid::Make(Capture(5, 4), 5, 1);
  EXPECT_FALSE(row->RecordedAt(0));  // between the two rows in the middle
}

TEST(ViewGrid, TakesOnlyRecordedLfCamerasAtItsPlaces) {
  LightField capture = Capture(5, 3);
  capture.cameras[3].is_virtual = true;
  capture.cameras[6].cam_from_world.translation.x() += 0.004;  // 0.8 % of the step
  capture.cameras[7].cam_from_world.translation.z() += 0.01;   // 2 %
  const auto grid = ViewGrid::Make(capture, 5, 3);
  ASSERT_TRUE(grid);
  EXPECT_FALSE(grid->RecordedAt(3));
  EXPECT_TRUE(grid->RecordedAt(6));
  EXPECT_FALSE(grid->RecordedAt(7));
}

TEST(ViewGrid, HasTheIntrinsicsOfRecordedLfImages) {
  LightField capture = Capture(5, 3);
  const int width_px = capture.intrinsics[7].width_px;
  capture.intrinsics[7].width_px += 40;
  capture.cameras[7].is_virtual = true;  // the one in the middle
  EXPECT_EQ(ViewGrid::Make(capture, 5, 3)->width_px(), width_px);
}

TEST(ViewGrid, OfBracketsHasNoLfCameras) {
  LightField capture = Capture(5, 3);
  capture.encoding.masks_clipped = true;
  const auto grid = ViewGrid::Make(capture, 5, 3);
  ASSERT_TRUE(grid);
  for (size_t view = 0; view < grid->size(); ++view) EXPECT_FALSE(grid->RecordedAt(view));
}

TEST(ViewGrid, HasTheIntrinsicsOfTheMiddleIfPrincipalPointsScatter) {
  LightField capture = Capture(5, 3);
  capture.intrinsics[2].cx_px += 5;
  capture.intrinsics[7].cx_px = 31;
  capture.intrinsics[7].distortion = {DistortionModel::kRadialTangential, {0.1}};
  const auto grid = ViewGrid::Make(capture, 5, 3);
  ASSERT_TRUE(grid);
  for (const size_t view : {size_t{0}, size_t{7}, size_t{14}}) {
    EXPECT_EQ(grid->Camera(view).intrinsics.cx_px, 31);
    EXPECT_FALSE(grid->Camera(view).intrinsics.has_distortion());
  }
}

TEST(ViewGrid, NeedsCamerasThatLookInOneDirection) {
  LightField dome;
  dome.intrinsics.push_back({100, 100, 32, 24, 0, 64, 48});
  for (int i = -4; i <= 4; ++i) {
    const Vec3 centre(std::sin(0.2 * i), 0, -std::cos(0.2 * i));
    LfCamera camera;
    camera.cam_from_world = *LookAlong(centre, -centre, -Vec3::UnitY());
    dome.cameras.push_back(camera);
    dome.image_names.push_back("a.png");
  }
  const auto grid = ViewGrid::Make(dome, 3, 3);
  ASSERT_FALSE(grid);
  EXPECT_EQ(grid.error().kind, ErrorKind::kInput);
  EXPECT_FALSE(ViewGrid::Make(Capture(2, 2), 0, 3));
  EXPECT_FALSE(ViewGrid::Make(Capture(2, 2), 3, kMostViewsAcross + 1));
}

}  // namespace
}  // namespace lf
