// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/nearby_cameras.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "lf/core/random.h"

namespace lf {
namespace {

// Returns cameras at random positions. A third of them look in the opposite direction.
LightField Scattered(uint32_t count) {
  LightField field;
  Intrinsics k;
  k.fx_px = k.fy_px = 100;
  k.cx_px = k.cy_px = 50;
  k.width_px = k.height_px = 100;
  field.intrinsics = {k};
  for (uint32_t i = 0; i < count; ++i) {
    LfCamera camera;
    const Vec3 centre(RandomUnit(1, i, 0), RandomUnit(1, i, 1), 0.1 * RandomUnit(1, i, 2));
    if (i % 3 == 0) camera.cam_from_world.rotation = Vec3(-1, 1, -1).asDiagonal();
    camera.cam_from_world.translation = -(camera.cam_from_world.rotation * centre);
    field.cameras.push_back(camera);
    field.image_names.push_back(std::to_string(i));
  }
  return field;
}

LightField Grid(int side, double spacing_w) {
  LightField field = Scattered(static_cast<uint32_t>(side * side));
  for (int i = 0; i < side * side; ++i) {
    RigidTransform& pose = field.cameras[static_cast<size_t>(i)].cam_from_world;
    pose.rotation.setIdentity();
    pose.translation = -spacing_w * Vec3(i % side, i / side, 0);
  }
  return field;
}

TEST(NearbyCameras, TheNearestThatLookTheSameWayAreFound) {
  const LightField field = Scattered(500);
  const NearbyCameras nearby(field);
  for (uint32_t camera = 0; camera < 50; ++camera) {
    const Vec3 point(1.4 * RandomUnit(2, camera, 0) - 0.2, RandomUnit(2, camera, 1), 0);
    std::vector<std::pair<double, uint32_t>> others;
    for (uint32_t i = 0; i < field.size(); ++i)
      if (i != camera && (i % 3 == 0) == (camera % 3 == 0))
        others.emplace_back((field.Camera(LfImageId{i}).CentreWorld() - point).norm(), i);
    std::sort(others.begin(), others.end());
    const std::vector<uint32_t> found = nearby.Nearest(point, 7, LfImageId{camera});
    ASSERT_EQ(found.size(), 7u);
    for (size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], others[i].second);
  }
}

TEST(NearbyCameras, FewerThanAskedForAreAllThatThereAre) {
  const LightField field = Scattered(4);
  EXPECT_EQ(NearbyCameras(field).Nearest(Vec3::Zero(), 7, LfImageId{1}).size(), 1u);
  EXPECT_TRUE(NearbyCameras(Scattered(1)).Nearest(Vec3::Zero(), 7, LfImageId{0}).empty());
}

TEST(NearbyCameras, EachRingIsTwiceAsWide) {
  const LightField field = Grid(30, 0.1);
  const Rings rings = NearbyCameras(field).DepthRings(LfImageId{14 * 30 + 15});
  ASSERT_EQ(rings.size(), 4u);
  double radius_w = 0.2;
  for (const std::vector<View>& ring : rings) {
    EXPECT_EQ(ring.size(), 6u);
    const double off_grid_w = radius_w < 1.4 ? 0.08 : 0.3;  // the outer ring leaves the grid
    for (const View& view : ring) EXPECT_NEAR(view.offset_w, radius_w, off_grid_w);
    radius_w *= 2;
  }
}

TEST(NearbyCameras, ViewsNearAndFarAreComparedOnce) {
  const LightField field = Grid(30, 0.1);
  const NearbyCameras nearby(field);
  const LfImageId camera{14 * 30 + 15};
  const std::vector<View> views = nearby.ComparedViews(camera, nearby.DepthRings(camera));
  std::set<uint32_t> ids;
  double nearest_w = 100, farthest_w = 0;
  for (const View& view : views) {
    EXPECT_TRUE(ids.insert(view.id.value).second);
    EXPECT_NE(view.id, camera);
    nearest_w = std::min(nearest_w, view.offset_w);
    farthest_w = std::max(farthest_w, view.offset_w);
  }
  EXPECT_NEAR(nearest_w, 0.1, 1e-9);
  EXPECT_GT(farthest_w, 1.2);
  EXPECT_GE(views.size(), 20u);
}

}  // namespace
}  // namespace lf
