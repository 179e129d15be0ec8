// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/camera_plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/core/random.h"
#include "lf/densify/camera_lattice.h"

namespace lf {
namespace {

std::vector<Vec2> Grid(int columns, int rows) {
  std::vector<Vec2> points;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) points.emplace_back(x, y);
  return points;
}

std::vector<Vec2> RandomPoints(int count, uint64_t seed) {
  RandomSequence random(seed);
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.Uniform(0, 10);
    points.emplace_back(x, random.Uniform(0, 10));
  }
  return points;
}

TEST(NaturalNeighbours, TheirWeightedMeanIsThePlace) {
  const std::vector<Vec2> points = RandomPoints(60, 1);
  RandomSequence random(2);
  for (int i = 0; i < 100; ++i) {
    const double x = random.Uniform(3, 7);
    const Vec2 place(x, random.Uniform(3, 7));
    const std::vector<WeightedPoint> neighbours = NaturalNeighbours(points, place);
    ASSERT_GE(neighbours.size(), 3u);
    Vec2 mean = Vec2::Zero();
    double sum = 0;
    for (const WeightedPoint& neighbour : neighbours) {
      EXPECT_GT(neighbour.weight, 0);
      mean += neighbour.weight * points[neighbour.index];
      sum += neighbour.weight;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR((mean - place).norm(), 0, 1e-9);
  }
}

TEST(NaturalNeighbours, InTheMiddleOfASquareAllCornersWeighTheSame) {
  const std::vector<WeightedPoint> found = NaturalNeighbours(Grid(4, 4), {1.5, 1.5});
  ASSERT_EQ(found.size(), 4u);
  for (const WeightedPoint& corner : found) EXPECT_NEAR(corner.weight, 0.25, 1e-12);
}

TEST(NaturalNeighbours, APointIsItsOwnOnlyNeighbour) {
  const std::vector<WeightedPoint> found = NaturalNeighbours(Grid(3, 3), {1, 2});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].index, 7u);
}

TEST(NaturalNeighbours, OutsideTheHullThereAreNone) {
  EXPECT_TRUE(NaturalNeighbours(Grid(3, 3), {1, 2.01}).empty());
  EXPECT_TRUE(NaturalNeighbours(Grid(3, 3), {-5, 1}).empty());
}

TEST(PlaceAmong, IsInterpolatedBetweenTwoOnALine) {
  const std::vector<Vec2> row = Grid(5, 1);
  const LatticePlace at = PlaceAmong(row, {1.75, 0.4});
  EXPECT_NEAR((at.inside - Vec2(1.75, 0)).norm(), 0, 1e-12);
  ASSERT_EQ(at.neighbours.size(), 2u);
  EXPECT_EQ(at.neighbours[0].index, 2u);
  EXPECT_NEAR(at.neighbours[0].weight, 0.75, 1e-12);
  EXPECT_EQ(at.neighbours[1].index, 1u);
  // Beyond the end, the last one is the only neighbour.
  const LatticePlace end = PlaceAmong(row, {6, 0});
  EXPECT_EQ(end.inside, Vec2(4, 0));
  ASSERT_EQ(end.neighbours.size(), 1u);
  EXPECT_EQ(end.neighbours[0].index, 4u);
}

TEST(PlaceAmong, BesideAnAreaItIsMovedInwards) {
  const LatticePlace at = PlaceAmong(Grid(3, 3), {1, 2.5});
  EXPECT_NEAR((at.inside - Vec2(1, 2)).norm(), 0, 0.01);
  EXPECT_GE(at.neighbours.size(), 2u);
}

TEST(Lattice, IsSpacedEvenlyAndKeepsAwayFromThePoints) {
  const std::vector<Vec2> points = RandomPoints(20, 3);
  constexpr double kDistance = 0.5;
  const std::vector<LatticePlace> lattice = LatticeAmong(points, kDistance, 0);
  EXPECT_GT(lattice.size(), 100u);
  for (const LatticePlace& a : lattice) {
    for (const Vec2& point : points) EXPECT_GE((a.place - point).norm(), kDistance / 2);
    for (const LatticePlace& b : lattice) {
      if (&a == &b) continue;
      EXPECT_GE((a.place - b.place).norm(), kDistance * (1 - 1e-9));
    }
    EXPECT_EQ(a.place, a.inside);
  }
}

TEST(Lattice, OutsideTheHullItReachesAsFarAsAskedFor) {
  const std::vector<Vec2> points = Grid(3, 3);
  double farthest = 0;
  for (const LatticePlace& at : LatticeAmong(points, 0.3, 0.5)) {
    const Vec2 beyond = (at.place - Vec2(1, 1)).cwiseAbs() - Vec2(1, 1);
    farthest = std::max(farthest, beyond.maxCoeff());
    EXPECT_LE(beyond.cwiseMax(0).norm(), 0.5 + 1e-9);
    EXPECT_FALSE(at.neighbours.empty());
    if (beyond.maxCoeff() <= 0) continue;
    EXPECT_LE((at.inside - at.place).norm(), 0.51);
  }
  EXPECT_GT(farthest, 0.3);
}

TEST(Lattice, OnlyPointsThatSurroundAnAreaAreOffOneLine) {
  EXPECT_FALSE(AreOnOneLine(Grid(3, 2)));
  EXPECT_TRUE(AreOnOneLine(Grid(5, 1)));
  EXPECT_TRUE(AreOnOneLine(Grid(2, 1)));
  // Three LF cameras of a hexagonal lattice leave no place of an equal lattice between them.
  const Vec2 triangle[] = {{0, 0}, {1, 0}, {0.5, 0.86602540378443865}};
  EXPECT_FALSE(AreOnOneLine(triangle));
}

TEST(MeanRotation, OfTurnsToBothSidesIsNoTurn) {
  const Mat3 left = Eigen::AngleAxisd(0.3, Vec3::UnitY()).toRotationMatrix();
  const Mat3 both[] = {left, left.transpose()};
  const double weights[] = {0.5, 0.5};
  EXPECT_NEAR((MeanRotation(both, weights) - Mat3::Identity()).norm(), 0, 1e-12);
  const double only_left[] = {1, 0};
  EXPECT_NEAR((MeanRotation(both, only_left) - left).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace lf
