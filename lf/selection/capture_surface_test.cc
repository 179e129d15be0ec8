// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/capture_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::vector<Vec3> Grid(int columns, int rows) {
  std::vector<Vec3> positions;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) positions.push_back({0.1 * x, 0.1 * y, 0});
  return positions;
}

double FractionOf(int32_t coordinate) {
  return static_cast<double>(coordinate) / SurfacePoint::kMost;
}

// Rows and columns of a grid stay such, whichever way the grid stands in the world.
TEST(CaptureSurface, GridsAreAlongTheAxes) {
  for (const double turn : {0.0, 0.2, 0.7, 1.5}) {
    std::vector<Vec3> positions = Grid(9, 7);
    const Mat3 rotation =
        (Eigen::AngleAxisd(turn, Vec3::UnitZ()) * Eigen::AngleAxisd(0.4 * turn, Vec3::UnitX()))
            .toRotationMatrix();
    for (Vec3& position : positions) position = rotation * position + Vec3(5, -3, 2);
    const std::vector<SurfacePoint> points = SurfaceOf(positions);
    std::vector<int32_t> xs, ys;
    for (const SurfacePoint& point : points) {
      xs.push_back(point.x);
      ys.push_back(point.y);
    }
    const int32_t wide = *std::max_element(xs.begin(), xs.end());
    const bool x_is_long = wide == SurfacePoint::kMost;
    for (size_t i = 0; i < points.size(); ++i) {
      const double column = 8 * FractionOf(x_is_long ? xs[i] : ys[i]);
      const double row = 8 * FractionOf(x_is_long ? ys[i] : xs[i]);
      EXPECT_NEAR(column, std::round(column), 1e-6) << turn;
      EXPECT_NEAR(row, std::round(row), 1e-6) << turn;
    }
  }
}

TEST(CaptureSurface, TheOrderOfPositionsDoesNotMatter) {
  std::vector<Vec3> positions = Grid(8, 8);
  const std::vector<SurfacePoint> points = SurfaceOf(positions);
  std::reverse(positions.begin(), positions.end());
  const std::vector<SurfacePoint> reversed = SurfaceOf(positions);
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].x, reversed[points.size() - 1 - i].x, 2);
    EXPECT_NEAR(points[i].y, reversed[points.size() - 1 - i].y, 2);
  }
}

// Parts of a hemisphere with equal areas have equal areas in the plane.
TEST(CaptureSurface, ASphereIsUnrolledWithEqualAreas) {
  std::vector<Vec3> positions;
  for (uint32_t i = 0; i < 4000; ++i) {
    const double z = RandomUnit(1, 0, i), angle = 2 * kPi * RandomUnit(1, 1, i);
    const double across = std::sqrt(1 - z * z);
    positions.push_back({7 + 3 * across * std::cos(angle), 3 * across * std::sin(angle), 3 * z});
  }
  const std::vector<SurfacePoint> points = SurfaceOf(positions);
  // The disk has the radius 1/2. Half of the area of the hemisphere is above z = 1/2, which is
  // within 1/sqrt(2) of the radius.
  size_t near = 0, wrong = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double x = FractionOf(points[i].x) - 0.5, y = FractionOf(points[i].y) - 0.5;
    const bool is_near = std::hypot(x, y) < 0.5 / std::sqrt(2.0);
    near += is_near ? 1 : 0;
    wrong += is_near != (positions[i].z() > 1.5) ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(near) / 4000, 0.5, 0.03);
  EXPECT_LT(wrong, 200U);  // the fitted middle is not exactly the pole
}

// A lens sees LF cameras beside and above each other, so that the plane must show both: also those
// of a narrow band in half a circle or in a circle.
TEST(CaptureSurface, BandsAreUnrolled) {
  for (const double turn : {kPi, 2 * kPi}) {
    constexpr int kColumns = 300;
    std::vector<Vec3> positions;
    for (const int row : {0, 1})
      for (int i = 0; i < kColumns; ++i)
        positions.push_back(
            {std::cos(turn * i / kColumns), 0.02 * row + 4, std::sin(turn * i / kColumns)});
    const std::vector<SurfacePoint> points = SurfaceOf(positions);
    const auto scale = [&](size_t a, size_t b) {
      return std::hypot(points[a].x - points[b].x, points[a].y - points[b].y) /
             (positions[a] - positions[b]).norm();
    };
    for (size_t i = 0; i + 1 < kColumns; ++i) {
      const double across = scale(i, i + kColumns), along = scale(i, i + 1);
      EXPECT_LT(std::max(across / along, along / across), 2.1) << turn << " " << i;
    }
  }
}

TEST(CaptureSurface, DegenerateCapturesAreAccepted) {
  EXPECT_TRUE(SurfaceOf({}).empty());
  const std::vector<Vec3> same(5, Vec3(1, 2, 3));
  for (const SurfacePoint& point : SurfaceOf(same)) EXPECT_EQ(point.x, 0);
  std::vector<Vec3> line;
  for (int i = 0; i < 9; ++i) line.push_back({1.0 * i, 2.0 * i, -1.0 * i});
  const std::vector<SurfacePoint> points = SurfaceOf(line);
  EXPECT_EQ(std::max(std::abs(points[8].x - points[0].x), std::abs(points[8].y - points[0].y)),
            SurfacePoint::kMost);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> undefined = {{nan, 0, 0}, {1, 0, 0}, {0, 1e308, -1e308}};
  EXPECT_EQ(SurfaceOf(undefined).size(), 3U);
}

}  // namespace
}  // namespace lf
