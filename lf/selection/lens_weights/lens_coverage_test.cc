// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/lens_coverage.h"

#include <gtest/gtest.h>

#include <vector>

namespace lf {
namespace {

// Returns a square grid of `side` x `side` points around `middle`.
std::vector<Vec2> Grid(int side, double spacing, const Vec2& middle = Vec2::Zero()) {
  std::vector<Vec2> points;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      points.push_back(middle + spacing * Vec2(x - 0.5 * (side - 1), y - 0.5 * (side - 1)));
  return points;
}

double UncoveredShare(const std::vector<Vec2>& points, const Aperture& aperture) {
  return CoverageOf(points, aperture).uncovered_share;
}

TEST(LensCoverage, TellsTheLargestLensThatFits) {
  EXPECT_NEAR(CoverageOf(Grid(11, 0.1), {1, 0, 0}).fitting_diameter_w, 1.1, 1e-9);
  EXPECT_NEAR(CoverageOf(Grid(11, 0.1, {0.2, 0}), {0.1, 0, 0}).fitting_diameter_w, 0.7, 1e-9);
  EXPECT_EQ(CoverageOf(Grid(11, 0.1, {3, 0}), {1, 0, 0}).fitting_diameter_w, 0);
}

TEST(LensCoverage, AGridAllOverTheLensCoversIt) {
  EXPECT_EQ(UncoveredShare(Grid(21, 0.1), {1, 0, 0}), 0);
  EXPECT_EQ(UncoveredShare(Grid(21, 0.1, {0.03, 0.04}), {0, 0, 0}), 0);
}

TEST(LensCoverage, HalfALensOfCamerasCoversHalfOfIt) {
  std::vector<Vec2> half;
  for (const Vec2& point : Grid(201, 0.01))
    if (point.x() < 0) half.push_back(point);
  EXPECT_NEAR(UncoveredShare(half, {1, 0, 0}), 0.5, 0.01);
  EXPECT_EQ(UncoveredShare(half, {0, 0, 0}), 0);
}

TEST(LensCoverage, BesideTheCamerasNothingIsCovered) {
  EXPECT_EQ(UncoveredShare(Grid(5, 0.1, {2, 0}), {0.5, 5, 0}), 1);
  EXPECT_EQ(UncoveredShare(Grid(5, 0.1, {2, 0}), {0, 0, 0}), 1);
  EXPECT_EQ(UncoveredShare({}, {1, 0, 0}), 1);
  const std::vector<Vec2> twice = {{0, 0}, {0, 0}};
  EXPECT_EQ(UncoveredShare(twice, {1, 0, 0}), 1);
}

TEST(LensCoverage, CamerasRecordedTwiceDoNotMakeDistancesSmaller) {
  std::vector<Vec2> points = Grid(21, 0.1);
  const std::vector<Vec2> again = points;
  points.insert(points.end(), again.begin(), again.end());
  EXPECT_EQ(UncoveredShare(points, {1, 0, 0}), 0);
  // The measured distance also does not become smaller if cameras tremble, if very many cameras are
  // at one place, or if some cameras crowd.
  for (size_t i = again.size(); i < points.size(); ++i) points[i].x() += 1e-5;
  EXPECT_EQ(UncoveredShare(points, {1, 0, 0}), 0);
  points = again;
  for (int i = 0; i < 500; ++i) points.emplace_back(0.3 + 1e-7 * i, 0.2);
  EXPECT_EQ(UncoveredShare(points, {1, 0, 0}), 0);
  points = again;
  for (const Vec2& point : Grid(15, 0.02, {0.3, 0.3})) points.push_back(point);
  EXPECT_EQ(UncoveredShare(points, {1, 0, 0}), 0);
}

}  // namespace
}  // namespace lf
