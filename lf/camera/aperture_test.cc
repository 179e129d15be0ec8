#include "lf/camera/aperture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

TEST(Aperture, TheRimOfADiskIsInside) {
  const Aperture disk{0.3, 0, 0};
  for (int i = 0; i < 100; ++i) {
    const double a = 2 * kPi * i / 100;
    EXPECT_TRUE(Contains(disk, 0.3 * Vec2(std::cos(a), std::sin(a))));
    EXPECT_FALSE(Contains(disk, 0.30001 * Vec2(std::cos(a), std::sin(a))));
  }
}

TEST(Aperture, AVertexIsUpAtRotationZero) {
  for (const int blades : {3, 4, 5, 6, 9}) {
    const Aperture polygon{2, blades, 0};
    const std::vector<Vec2> vertices = Vertices(polygon);
    ASSERT_EQ(vertices.size(), static_cast<size_t>(blades));
    EXPECT_NEAR((vertices[0] - Vec2(0, 2)).norm(), 0, 1e-12);
    for (const Vec2& v : vertices) EXPECT_TRUE(Contains(polygon, v));
    for (const Vec2& v : vertices) EXPECT_FALSE(Contains(polygon, 1.0001 * v));
  }
}

TEST(Aperture, RotationTurnsRightTowardsUp) {
  // A quarter turn takes the upper vertex to the left.
  const Aperture triangle{1, 3, kPi / 2};
  EXPECT_NEAR((Vertices(triangle)[0] - Vec2(-1, 0)).norm(), 0, 1e-12);
  // 20 degrees: the vertex that was up moves to the left of up.
  EXPECT_LT(Vertices({1, 3, RadiansFromDegrees(20)})[0].x(), 0);
}

TEST(Aperture, AThirdOfATurnChangesNoTriangle) {
  const Aperture a{1, 3, 0.2}, b{1, 3, 0.2 + 2 * kPi / 3};
  for (uint64_t i = 0; i < 2000; ++i) {
    const Vec2 p(2 * RandomUnit(1, 0, i) - 1, 2 * RandomUnit(1, 1, i) - 1);
    EXPECT_EQ(Contains(a, p), Contains(b, p));
  }
}

TEST(Aperture, EdgesAndInsideTestAgree) {
  for (const int blades : {3, 5, 8}) {
    const Aperture polygon{1, blades, 0.4};
    size_t inside_count = 0;
    constexpr size_t kCount = 40000;
    for (uint64_t i = 0; i < kCount; ++i) {
      const Vec2 p(2 * RandomUnit(7, 0, i) - 1, 2 * RandomUnit(7, 1, i) - 1);
      inside_count += Contains(polygon, p);
    }
    EXPECT_NEAR(4.0 * inside_count / kCount, Area(polygon), 0.04);
  }
}

TEST(Aperture, TheCircumscribedPolygonHoldsTheDisk) {
  for (const ApertureEdge& edge : Edges({1, 0, 0}, 16)) {
    EXPECT_DOUBLE_EQ(edge.normal.norm(), 1);
    EXPECT_DOUBLE_EQ(edge.distance_w, 1);
  }
}

TEST(Aperture, LensSamplesAreInsideAndUniform) {
  for (const int blades : {0, 3, 5}) {
    const Aperture aperture{0.5, blades, 0.1};
    const std::vector<Vec2> points = SampleLens(aperture, 4000, 3);
    Vec2 mean = Vec2::Zero();
    double squared = 0;
    for (const Vec2& p : points) {
      EXPECT_TRUE(Contains(aperture, p));
      mean += p / points.size();
      squared += p.squaredNorm() / points.size();
    }
    EXPECT_NEAR(mean.norm(), 0, 2e-3);
    // Second moment: r^2 / 2 of a disk, r^2 (2 + cos(2 pi / n)) / 6 of a polygon.
    const double expected = blades == 0 ? 0.125 : 0.25 * (2 + std::cos(2 * kPi / blades)) / 6;
    EXPECT_NEAR(squared, expected, 1e-3);
  }
}

}  // namespace
}  // namespace lf
