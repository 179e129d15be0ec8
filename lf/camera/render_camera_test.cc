// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/render_camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lf {
namespace {

RenderCamera Camera(FocusTilt tilt) {
  RenderCamera camera;
  camera.pinhole.intrinsics = {400, 400, 160, 120, 0, 320, 240};
  camera.pinhole.cam_from_world = *LookAlong({1, 2, 3}, {1, 0.2, -0.5}, {0, 0, 1});
  camera.aperture = {0.01, 0, 0};
  camera.focus_distance_w = 2;
  camera.focus_tilt = tilt;
  camera.focus_plane = FocusPlane(camera.pinhole, 2, tilt);
  return camera;
}

TEST(FocusPlane, IsAtTheFocusDistanceAlongTheAxis) {
  for (const FocusTilt tilt : {FocusTilt{}, FocusTilt{0.6, 0}, FocusTilt{0, -0.6}}) {
    const RenderCamera camera = Camera(tilt);
    const Vec3 point = *FocusPointOfElement(camera, 160, 120);
    EXPECT_NEAR((point - camera.pinhole.CentreWorld()).norm(), 2, 1e-12);
  }
}

TEST(FocusPlane, TiltsAreDepthsToTheRightAndUp) {
  const FocusTilt tilt{0.5, -0.3};
  const RenderCamera camera = Camera(tilt);
  for (const Vec2& element : {Vec2(10, 20), Vec2(300, 100), Vec2(160, 230)}) {
    const Vec3 point_camera =
        camera.pinhole.cam_from_world * *FocusPointOfElement(camera, element.x(), element.y());
    const double right = point_camera.x(), up = -point_camera.y();
    EXPECT_NEAR(point_camera.z(), 2 + right * std::tan(0.5) + up * std::tan(-0.3), 1e-9);
  }
}

TEST(FocusPlane, ElementsBeyondTheHorizonSeeNothing) {
  const RenderCamera camera = Camera({RadiansFromDegrees(80), 0});
  EXPECT_TRUE(FocusPointOfElement(camera, 20, 120));
  EXPECT_FALSE(FocusPointOfElement(camera, 300, 120));
}

TEST(LensPoint, RightAndUpAreThoseOfThePhotographer) {
  const RenderCamera camera = Camera({});
  const Vec3 point = camera.pinhole.cam_from_world * LensPointWorld(camera, {0.3, 0.1});
  EXPECT_NEAR((point - Vec3(0.3, -0.1, 0)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace lf
