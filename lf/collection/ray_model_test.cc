// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/ray_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lf {
namespace {

// The plate has 100 x 100 elements and the LF image 100 x 100 pixels. The focal length of both
// cameras is 100 elements or pixels. The render camera looks along +z from the origin. The focus
// plane is at z = 2.
struct Scene {
  PinholeCamera lf_camera;
  RenderCamera render;

  Scene() {
    render.pinhole.intrinsics = {100, 100, 50, 50, 0, 100, 100};
    render.aperture = {0.1, 0, 0};
    render.focus_plane = {Vec3::UnitZ(), 2};
    lf_camera.intrinsics = render.pinhole.intrinsics;
  }
  void Place(const Vec3& centre, const Vec3& forward = {0, 0, 1}) {
    lf_camera.cam_from_world = *LookAlong(centre, forward, {0, -1, 0});
  }
  std::optional<PlateElement> Collect(int x, int y) const {
    return RayModel(lf_camera, render).Collect(x, y);
  }
  int AcceptedCount() const {
    const RayModel model(lf_camera, render);
    int count = 0;
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 100; ++x) count += model.Collect(x, y).has_value();
    return count;
  }
};

TEST(RayModel, TheSameCameraReproducesItself) {
  Scene scene;
  for (const int x : {0, 37, 99})
    for (const int y : {0, 50, 99}) EXPECT_EQ(scene.Collect(x, y), (PlateElement{x, y}));
}

TEST(RayModel, ACameraToTheRightSeesTheFocusPlaneShifted) {
  Scene scene;
  scene.Place({0.06, 0, 0});  // disparity f x / g = 3 elements
  EXPECT_EQ(scene.Collect(20, 30), (PlateElement{23, 30}));
  EXPECT_FALSE(scene.Collect(97, 30));
  EXPECT_EQ(scene.AcceptedCount(), 97 * 100);
}

TEST(RayModel, CoordinatesLeftOfThePlateAreNotTruncatedIntoIt) {
  Scene scene;
  scene.Place({-0.011, 0, 0});  // 0.55 elements to the left
  EXPECT_FALSE(scene.Collect(0, 10));
  EXPECT_EQ(scene.Collect(1, 10), (PlateElement{0, 10}));
}

TEST(RayModel, CamerasOnTheRimAreInside) {
  for (int i = 0; i < 360; ++i) {
    Scene scene;
    const double a = RadiansFromDegrees(i);
    scene.Place({0.1 * std::cos(a), 0.1 * std::sin(a), 0});
    EXPECT_TRUE(scene.Collect(50, 50)) << i;
    scene.Place({0.1001 * std::cos(a), 0.1001 * std::sin(a), 0});
    EXPECT_FALSE(scene.Collect(50, 50)) << i;
  }
}

TEST(RayModel, CamerasBeforeAndBehindTheLensSeeItAsACone) {
  // A ray at slope s, from a camera on the axis at distance 1 from the lens, crosses the lens at
  // radius s.
  for (const double z : {1.0, -1.0}) {
    Scene scene;
    scene.Place({0, 0, z});
    EXPECT_TRUE(scene.Collect(50, 50));
    EXPECT_TRUE(scene.Collect(59, 50));   // slope 0.095
    EXPECT_FALSE(scene.Collect(60, 50));  // slope 0.105
    EXPECT_NEAR(scene.AcceptedCount(), kPi * 10 * 10, 12);
  }
}

TEST(RayModel, ACameraBehindTheFocusPlaneRecordsTheLineBackwards) {
  // The LF camera stands behind the focus plane and looks away from the lens. Its rays, extended
  // backwards, pass through the focus plane and the lens.
  Scene scene;
  scene.Place({0, 0, 3});
  // A ray at slope s meets the focus plane at -s and the lens at -3 s. Rays up to slope 1/30 are
  // accepted.
  EXPECT_TRUE(scene.Collect(50, 50));
  EXPECT_EQ(scene.Collect(52, 50), (PlateElement{48, 49}));
  EXPECT_FALSE(scene.Collect(54, 50));
}

TEST(RayModel, ImagesLookingTheOtherWayGiveNothing) {
  Scene scene;
  scene.Place({0, 0, 1}, {0, 0, -1});
  EXPECT_EQ(scene.AcceptedCount(), 0);
  scene.Place({0.01, 0, 0}, {0, 0, -1});
  EXPECT_EQ(scene.AcceptedCount(), 0);
}

TEST(RayModel, ElementsBeyondTheHorizonOfATiltedPlaneGetNothing) {
  Scene scene;
  scene.render.focus_plane =
      FocusPlane(scene.render.pinhole, 1, {RadiansFromDegrees(75), 0});  // depth 1 + 3.73 x
  const RayModel model(scene.lf_camera, scene.render);
  // Pixel x looks along (x - 49.5) / 100. The horizon of the focus plane is at slope 1 / tan 75
  // degrees = 0.268, in pixel 76.
  int last = -1;
  for (int x = 0; x < 100; ++x)
    if (model.Collect(x, 50)) {
      EXPECT_EQ(x, last + 1);
      EXPECT_EQ(model.Collect(x, 50), (PlateElement{x, 50}));
      last = x;
    }
  EXPECT_EQ(last, 76);
}

TEST(RayModel, ACameraInTheFocusPlaneSendsAllItsRaysToOneElement) {
  Scene scene;
  scene.Place({0.5, 0.1, 2});
  scene.render.aperture.radius_w = 10;
  const std::optional<PlateElement> first = scene.Collect(50, 50);
  EXPECT_EQ(first, (PlateElement{75, 55}));
  EXPECT_EQ(scene.Collect(10, 80), first);
}

TEST(RayModel, PolygonsTakeTheirVerticesAndNotTheCircleBetween) {
  Scene scene;
  scene.render.aperture = {0.1, 3, 0};
  scene.Place({0, -0.1, 0});  // straight above the lens centre (y points down): at the vertex
  EXPECT_TRUE(scene.Collect(50, 50));
  scene.Place({0, 0.05, 0});  // on the lower edge
  EXPECT_TRUE(scene.Collect(50, 50));
  scene.Place({0, 0.051, 0});
  EXPECT_FALSE(scene.Collect(50, 50));
}

}  // namespace
}  // namespace lf
