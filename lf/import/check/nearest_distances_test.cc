// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/nearest_distances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lf/core/random.h"

namespace lf {
namespace {

std::vector<double> BruteForce(const std::vector<Vec3>& points) {
  std::vector<double> distances;
  for (size_t i = 0; i < points.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < points.size(); ++k)
      if (k != i) least = std::min(least, (points[k] - points[i]).norm());
    distances.push_back(least);
  }
  return distances;
}

// Returns points that are random in the first `dimensions` coordinates and constant in the others.
std::vector<Vec3> RandomPoints(size_t count, int dimensions) {
  std::vector<Vec3> points;
  for (uint64_t i = 0; i < count; ++i) {
    Vec3 point(5, -3, 2);
    for (int axis = 0; axis < dimensions; ++axis)
      point[axis] =
          static_cast<double>(RandomBits(7, static_cast<uint64_t>(axis), i) >> 11) * 1e-16;
    points.push_back(point);
  }
  return points;
}

TEST(NearestDistances, EqualBruteForceOnLinesPlanesAndInSpace) {
  ThreadPool pool(2);
  for (int dimensions = 1; dimensions <= 3; ++dimensions)
    for (const size_t count : {2, 9, 17, 700}) {
      const std::vector<Vec3> points = RandomPoints(count, dimensions);
      const std::vector<double> distances = NearestDistances(points, pool);
      const std::vector<double> expected = BruteForce(points);
      ASSERT_EQ(distances.size(), count);
      for (size_t i = 0; i < count; ++i) EXPECT_DOUBLE_EQ(distances[i], expected[i]);
    }
}

TEST(NearestDistances, EqualBruteForceWhereManyCoordinatesAreEqual) {
  ThreadPool pool(1);
  std::vector<Vec3> points;
  for (int i = 0; i < 400; ++i) points.push_back(Vec3(i % 20, (i / 20) * 2, 0));
  points.push_back(points[7]);
  EXPECT_EQ(NearestDistances(points, pool), BruteForce(points));
}

TEST(NearestDistances, AreZeroWhereAllPointsAreOne) {
  ThreadPool pool(1);
  const std::vector<Vec3> points(5000, Vec3(1, 2, 3));
  EXPECT_EQ(NearestDistances(points, pool), std::vector<double>(5000, 0.0));
}

TEST(NearestDistances, OfFewerThanTwoPointsAreNone) {
  ThreadPool pool(1);
  EXPECT_TRUE(NearestDistances({}, pool).empty());
  EXPECT_TRUE(std::isinf(NearestDistances(std::vector<Vec3>{Vec3(1, 2, 3)}, pool).front()));
}

}  // namespace
}  // namespace lf
