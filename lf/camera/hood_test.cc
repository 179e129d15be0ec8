// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/hood.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/testing_scenes.h"
#include "lf/core/random.h"

namespace lf {
namespace {

RenderCamera Hooded(double distance_w, double radius_w) {
  RenderCamera camera;
  camera.pinhole.intrinsics = {100, 100, 50, 40, 0, 100, 80};
  camera.pinhole.cam_from_world = *LookAlong({0.1, 0.2, 0.3}, {0.1, 0, 1}, {0, -1, 0.1});
  camera.aperture = {0.1, 0, 0};
  camera.focus_plane = FocusPlane(camera.pinhole, 2, {0.2, 0});
  camera.hood = {distance_w, radius_w};
  return camera;
}

TEST(Hood, HasTheAreaOfItsDisk) {
  const Hood hood{1, 0.25};
  const std::vector<ApertureEdge> edges = Edges(hood);
  ASSERT_EQ(edges.size(), static_cast<size_t>(kHoodEdges));
  double area = 0;  // of the triangles from the centre to the edges
  for (const ApertureEdge& edge : edges)
    area += edge.distance_w * edge.distance_w * std::tan(kPi / kHoodEdges);
  EXPECT_NEAR(area, kPi * 0.25 * 0.25, 1e-12);
  EXPECT_TRUE(Edges(Hood{}).empty());
}

TEST(Hood, CutsTheLensAsItCutsRays) {
  // The last hood is farther away than the focus plane.
  for (const double distance_w : {0.0, 0.3, 1.2, 5.0}) {
    const RenderCamera camera = Hooded(distance_w, 0.12);
    const HoodTest test(camera);
    int passing = 0, all = 0;
    for (uint64_t i = 0; i < 4000; ++i) {
      const Vec2 on_lens(0.3 * RandomUnit(1, 0, i) - 0.15, 0.3 * RandomUnit(1, 1, i) - 0.15);
      const auto focus =
          FocusPointOfElement(camera, 100 * RandomUnit(1, 2, i), 80 * RandomUnit(1, 3, i));
      ASSERT_TRUE(focus);
      const Vec3 from = LensPointWorld(camera, on_lens);
      const bool passes = test.LetsThrough(from, *focus - from);
      bool is_inside = true;
      for (const ApertureEdge& edge : HoodOnLens(camera, *focus))
        is_inside = is_inside && edge.normal.dot(on_lens) <= edge.distance_w * (1 + 1e-9) + 1e-12;
      EXPECT_EQ(passes, is_inside);
      // Another point of the same line gives the same answer.
      EXPECT_EQ(passes, test.LetsThrough(*focus, from - *focus));
      passing += passes;
      ++all;
    }
    EXPECT_GT(passing, 0) << distance_w;
    EXPECT_LT(passing, all) << distance_w;
  }
}

TEST(Hood, LetsTheAxisThroughAndCutsObliqueRays) {
  const RenderCamera camera = Hooded(0.5, 0.05);
  const HoodTest test(camera);
  const Vec3 centre = camera.pinhole.CentreWorld();
  EXPECT_TRUE(test.LetsThrough(centre, camera.pinhole.ForwardWorld()));
  // At the hood, this ray is 0.06 to the right of the axis.
  EXPECT_FALSE(
      test.LetsThrough(centre, camera.pinhole.ForwardWorld() + 0.12 * camera.pinhole.RightWorld()));
  EXPECT_TRUE(HoodTest(RenderCamera{}).LetsThrough(Vec3::Zero(), Vec3::UnitX()));
}

TEST(Hood, OpeningUpRemovesIt) {
  RenderCamera camera = Hooded(0.5, 0.05);
  EXPECT_TRUE(HasShape(camera));
  OpenUpTo(0.3, &camera);
  EXPECT_FALSE(HasShape(camera));
  EXPECT_EQ(camera.aperture.radius_w, 0.3);
}

}  // namespace
}  // namespace lf
