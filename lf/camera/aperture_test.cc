// SPDX-License-Identifier: Apache-2.0
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

// Openings with curved or squeezed edges.
std::vector<Aperture> Shapes() {
  return {{1.5, 0, 0.3, 2, 0},   {1.5, 0, 0, 0.4, 0},     {1.5, 5, 0.2, 1, 0.5},
          {1.5, 3, 0, 1, 0.01},  {1.5, 8, 0.1, 1.7, 0.8}, {1.5, 6, 0, 0.6, 0},
          {1.5, 7, 0.2, 1, 0.9}, {1.5, 40, 0, 1, 0.5},    {1.5, 6, 0.3, 3, 1}};
}

// Returns true if the point lies in the opening by its definition: a disk, or the part of a disk in
// front of the arcs of its blades, squeezed.
bool LiesInside(const Aperture& aperture, const Vec2& point) {
  const Vec2 squeeze(std::min(1.0, 1 / aperture.ratio), std::min(1.0, aperture.ratio));
  const Vec2 p = point.cwiseQuotient(squeeze) / aperture.radius_w;
  if (aperture.blades == 0 || aperture.roundness == 1) return p.norm() <= 1;
  const double half = kPi / aperture.blades;
  const double from = std::atan2(p.y(), p.x()) - kPi / 2 - aperture.rotation_rad - half;
  const double folded = from - 2 * half * std::round(from / (2 * half));
  const Vec2 q(p.norm() * std::cos(folded), p.norm() * std::sin(folded));
  if (aperture.roundness == 0) return q.x() <= std::cos(half);
  // The circle through the two vertices and the middle of the arc.
  const double top = std::cos(half) + aperture.roundness * (1 - std::cos(half));
  const double centre = (top * top - 1) / (2 * (top - std::cos(half)));
  return (q - Vec2(centre, 0)).norm() <= top - centre;
}

TEST(Aperture, CurvedEdgesAreThoseOfTheShape) {
  for (const Aperture& shape : Shapes()) {
    size_t differing = 0, inside = 0;
    constexpr size_t kCount = 20000;
    for (uint64_t i = 0; i < kCount; ++i) {
      const Vec2 p(3 * RandomUnit(3, 0, i) - 1.5, 3 * RandomUnit(3, 1, i) - 1.5);
      inside += Contains(shape, p);
      differing += Contains(shape, p) != LiesInside(shape, p);
    }
    EXPECT_LT(differing, 0.004 * kCount) << shape.blades << " " << shape.ratio;
    EXPECT_NEAR(9.0 * inside / kCount, Area(shape), 0.03 * 9);
    EXPECT_FALSE(shape.IsDisk() ||
                 shape.IsPlainPolygon() != (shape.ratio == 1 && !shape.roundness));
  }
}

TEST(Aperture, ShapesHaveAtMostFortyEdgesWithinTheirCircle) {
  for (const Aperture& shape : Shapes()) {
    const std::vector<Vec2> vertices = Vertices(shape);
    EXPECT_EQ(Edges(shape).size(), vertices.size());
    EXPECT_LE(vertices.size(), 40u);
    double farthest = 0;
    for (const Vec2& v : vertices) {
      farthest = std::max(farthest, v.norm());
      EXPECT_TRUE(Contains(shape, v));
      EXPECT_FALSE(Contains(shape, 1.0001 * v));
    }
    // A polygon that has the area of a circle reaches a little beyond it.
    EXPECT_LE(farthest, 1.5 * 1.0025);
  }
}

TEST(Aperture, FullRoundnessIsADisk) {
  const Aperture round{1, 6, 0.4, 1, 1};
  EXPECT_TRUE(round.IsDisk());
  EXPECT_TRUE(Vertices(round).empty());
  EXPECT_EQ(Area(round), Area({1, 0, 0}));
}

TEST(Aperture, SamplesFillShapesEvenly) {
  for (const Aperture& shape : Shapes()) {
    constexpr int kCount = 4000;
    Vec2 mean = Vec2::Zero();
    int upper = 0, in_half_size = 0;
    Aperture half = shape;
    half.radius_w /= 2;
    for (const Vec2& p : SampleLens(shape, kCount)) {
      EXPECT_TRUE(LiesInside(shape, p / 1.003));
      mean += p / kCount;
      upper += p.y() > 0;
      in_half_size += Contains(half, p);
    }
    EXPECT_LT(mean.norm(), shape.blades == 3 ? 0.02 : 0.01);
    EXPECT_NEAR(in_half_size, 0.25 * kCount, 0.02 * kCount);
    if (shape.blades % 2 == 0) {
      EXPECT_NEAR(upper, 0.5 * kCount, 0.02 * kCount);
    }
  }
}

TEST(Aperture, APinholeOfAnyShapeHasOnePoint) {
  for (Aperture shape : Shapes()) {
    shape.radius_w = 0;
    EXPECT_TRUE(Contains(shape, Vec2::Zero()));
    EXPECT_FALSE(Contains(shape, Vec2(1e-9, 0)));
    EXPECT_EQ(SampleLens(shape, 1)[0], Vec2::Zero());
  }
}

}  // namespace
}  // namespace lf
