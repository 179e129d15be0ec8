// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

Vec3 RandomPoint(uint64_t stream, uint64_t i) {
  return 2 * Vec3(RandomUnit(5, stream, 3 * i), RandomUnit(5, stream, 3 * i + 1),
                  RandomUnit(5, stream, 3 * i + 2)) -
         Vec3::Ones();
}

TEST(Shapes, ARayMeetsASphereAtItsAnalyticDistance) {
  const Sphere sphere{{0, 0, 5}, 2, 0};
  EXPECT_NEAR(*Intersect({Vec3::Zero(), Vec3::UnitZ()}, sphere), 3, 1e-12);
  // The ray passes the centre at a distance of 1.2. It meets the sphere sqrt(2^2 - 1.2^2) = 1.6 in
  // front of the point nearest to the centre: at 5 - 1.6 = 3.4.
  EXPECT_NEAR(*Intersect({{1.2, 0, 0}, Vec3::UnitZ()}, sphere), 3.4, 1e-12);
  EXPECT_FALSE(Intersect({{2.001, 0, 0}, Vec3::UnitZ()}, sphere));
  EXPECT_FALSE(Intersect({Vec3::Zero(), -Vec3::UnitZ()}, sphere));
}

TEST(Shapes, FromWithinASphereTheFarSideIsMet) {
  const Sphere sphere{{0, 0, 5}, 2, 0};
  EXPECT_NEAR(*Intersect({{0, 0, 5}, Vec3::UnitX()}, sphere), 2, 1e-12);
  // The ray starts at the front of the sphere.
  EXPECT_NEAR(*Intersect({{0, 0, 3}, Vec3::UnitZ()}, sphere), 4, 1e-12);
}

TEST(Shapes, APanelEndsAtItsEdgesAndADiskAtItsRim) {
  Panel panel{{0, 0, 2}, {0.5, 0, 0}, {0, -0.25, 0}, false, 0};
  const auto meets = [&panel](double x, double y) {
    return Intersect({{x, y, 0}, Vec3::UnitZ()}, PanelPlane(panel)).has_value();
  };
  EXPECT_TRUE(meets(0.499, 0.249));
  EXPECT_FALSE(meets(0.501, 0));
  EXPECT_FALSE(meets(0, 0.251));
  panel.is_disk = true;
  EXPECT_FALSE(meets(0.499, 0.249));
  EXPECT_TRUE(meets(0.499, 0));
}

TEST(Shapes, APanelIsMetFromBothSidesAtTheDistanceOfItsPlane) {
  // The plane x + z = 2.
  const PanelPlane panel({{1, 0, 1}, {3, 0, -3}, {0, 3, 0}, false, 0});
  EXPECT_NEAR(*Intersect({{0.5, 0, 0}, Vec3::UnitZ()}, panel), 1.5, 1e-12);
  EXPECT_NEAR(*Intersect({{0.5, 0, 3}, -Vec3::UnitZ()}, panel), 1.5, 1e-12);
  EXPECT_FALSE(Intersect({{0.5, 0, 0}, Vec3(1, 0, -1).normalized()}, panel));  // parallel to it
}

TEST(Shapes, TheFirstHitIsTheNearestOfAll) {
  std::vector<Sphere> spheres;
  for (uint64_t i = 0; i < 37; ++i)
    spheres.push_back({RandomPoint(0, i), 0.02 + 0.2 * RandomUnit(6, 0, i), 0});
  std::vector<Panel> panels;
  for (uint64_t i = 0; i < 3; ++i)
    panels.push_back({RandomPoint(1, i), 0.3 * RandomPoint(2, i), Vec3::Zero(), i == 1, 0});
  for (Panel& panel : panels) panel.half_up_w = panel.half_right_w.unitOrthogonal() * 0.3;
  const Shapes shapes(spheres, panels);
  int hit_count = 0;
  for (uint64_t i = 0; i < 5000; ++i) {
    const Ray ray{2 * RandomPoint(3, i), RandomPoint(4, i).normalized()};
    Hit expected;
    for (uint32_t s = 0; s < spheres.size() + panels.size(); ++s) {
      const std::optional<double> lambda =
          s < spheres.size() ? Intersect(ray, spheres[s])
                             : Intersect(ray, PanelPlane(panels[s - spheres.size()]));
      if (lambda && *lambda < expected.lambda) expected = {*lambda, s};
    }
    const Hit hit = shapes.FirstHit(ray);
    EXPECT_EQ(hit.shape, expected.shape);
    EXPECT_EQ(hit.lambda, expected.lambda);
    hit_count += hit ? 1 : 0;
  }
  EXPECT_GT(hit_count, 300);
}

}  // namespace
}  // namespace lf
