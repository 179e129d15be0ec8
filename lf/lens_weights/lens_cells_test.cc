#include "lf/lens_weights/lens_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lf/core/random.h"

namespace lf {
namespace {

const Aperture kOpenings[] = {{1, 0, 0}, {1, 3, 0.3}, {1, 5, 0}, {1, 8, 0.1}};

double Sum(const std::vector<double>& areas) {
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::vector<Vec2> RandomPoints(size_t count, double reach, uint64_t seed) {
  RandomSequence random(seed);
  std::vector<Vec2> points;
  for (size_t i = 0; i < count; ++i) {
    const double x = random.Uniform(-reach, reach);
    points.emplace_back(x, random.Uniform(-reach, reach));
  }
  return points;
}

// The share of the opening's samples that are nearest to each point.
std::vector<double> AreasBySampling(const std::vector<Vec2>& points, const Aperture& aperture,
                                    int samples) {
  std::vector<double> areas(points.size());
  for (const Vec2& sample : SampleLens(aperture, samples)) {
    const auto nearest =
        std::min_element(points.begin(), points.end(), [&](const Vec2& a, const Vec2& b) {
          return (a - sample).squaredNorm() < (b - sample).squaredNorm();
        });
    areas[static_cast<size_t>(nearest - points.begin())] += Area(aperture) / samples;
  }
  return areas;
}

TEST(LensCells, OnePointStandsForTheWholeLensWhereverItIs) {
  for (const Aperture& aperture : kOpenings)
    for (const Vec2& point : {Vec2(0, 0), Vec2(0.9, 0), Vec2(30, -7)}) {
      const std::vector<double> areas = LensCellAreas(std::vector{point}, aperture);
      ASSERT_EQ(areas.size(), 1u);
      EXPECT_NEAR(areas[0], Area(aperture), 1e-12);
    }
  EXPECT_TRUE(LensCellAreas({}, kOpenings[0]).empty());
}

TEST(LensCells, CellsTileTheLens) {
  for (const Aperture& aperture : kOpenings)
    for (const size_t count : {2, 3, 7, 100, 3000})
      for (const double reach : {0.01, 1.0, 3.0}) {
        const auto points = RandomPoints(count, reach, count);
        const auto areas = LensCellAreas(points, aperture);
        EXPECT_NEAR(Sum(areas), Area(aperture), 1e-11) << count << " within " << reach;
        for (const double area : areas) EXPECT_GE(area, -1e-13);
      }
}

TEST(LensCells, AreasAreThoseOfTheNearestPoints) {
  constexpr int kSamples = 200000;
  for (const Aperture& aperture : kOpenings)
    for (const uint64_t seed : {1, 2, 3}) {
      // Uneven: two thirds of the points in a corner.
      std::vector<Vec2> points = RandomPoints(20, 1.5, seed);
      for (const Vec2& p : RandomPoints(40, 0.4, seed + 9)) points.push_back(p + Vec2(0.6, 0.5));
      const auto areas = LensCellAreas(points, aperture);
      const auto expected = AreasBySampling(points, aperture, kSamples);
      for (size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(areas[i], expected[i], 1e-3) << i;
    }
}

TEST(LensCells, InTheMiddleOfAGridTheyAreItsSquares) {
  std::vector<Vec2> points;
  for (int y = -12; y <= 12; ++y)
    for (int x = -12; x <= 12; ++x) points.emplace_back(0.1 * x, 0.1 * y);
  for (const Aperture& aperture : kOpenings) {
    const auto areas = LensCellAreas(points, aperture);
    for (size_t i = 0; i < points.size(); ++i) {
      const double distance = points[i].norm();
      if (distance >= 0.35 && distance <= 1.08) continue;
      EXPECT_NEAR(areas[i], distance < 1 ? 0.01 : 0, 1e-12) << points[i].transpose();
    }
  }
  // Half of the square of the camera at (1, 0) reaches into the disk, less what the rim cuts off.
  const auto areas = LensCellAreas(points, kOpenings[0]);
  const double half_chord = 0.05, rim = std::asin(half_chord) + half_chord * std::sqrt(1 - 0.0025);
  EXPECT_NEAR(areas[12 * 25 + 22], rim - 0.95 * 0.1, 1e-12);
}

TEST(LensCells, PointsAtOnePlaceShareTheirCell) {
  std::vector<Vec2> points = RandomPoints(50, 1, 4);
  const auto single = LensCellAreas(points, kOpenings[0]);
  for (int i = 0; i < 3; ++i) points.push_back(points[17]);
  const auto shared = LensCellAreas(points, kOpenings[0]);
  for (size_t i = 0; i < 50; ++i)
    EXPECT_NEAR(shared[i], i == 17 ? single[i] / 4 : single[i], 1e-12);
  for (size_t i = 50; i < 53; ++i) EXPECT_NEAR(shared[i], single[17] / 4, 1e-12);
  const std::vector<Vec2> all_the_same(5, Vec2(0.2, 0.1));
  for (const double area : LensCellAreas(all_the_same, kOpenings[2]))
    EXPECT_NEAR(area, Area(kOpenings[2]) / 5, 1e-12);
}

TEST(LensCells, CamerasOnALineCutTheLensIntoStrips) {
  for (const Vec2& along : {Vec2(1, 0), Vec2(0, 1), Vec2(0.6, 0.8)}) {
    std::vector<Vec2> points;
    for (int i = -30; i <= 30; ++i) points.emplace_back(0.05 * i * along);
    const auto areas = LensCellAreas(points, kOpenings[0]);
    // Between the chords at distances a and b.
    const auto below = [](double d) { return std::asin(d) + d * std::sqrt(1 - d * d); };
    for (int i = -19; i <= 19; ++i)
      EXPECT_NEAR(areas[static_cast<size_t>(i + 30)],
                  below(0.05 * i + 0.025) - below(0.05 * i - 0.025), 1e-12);
  }
}

TEST(LensCells, AreAsLargeInAnyUnit) {
  const auto points = RandomPoints(80, 1.2, 11);
  const auto areas = LensCellAreas(points, kOpenings[1]);
  for (const double unit : {1e-6, 1e6}) {
    std::vector<Vec2> scaled;
    for (const Vec2& p : points) scaled.push_back(unit * p);
    const auto scaled_areas = LensCellAreas(scaled, {unit, 3, 0.3});
    for (size_t i = 0; i < points.size(); ++i)
      EXPECT_NEAR(scaled_areas[i] / unit / unit, areas[i], 1e-11);
  }
}

}  // namespace
}  // namespace lf
