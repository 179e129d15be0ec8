// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/lens_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lf/core/convex_hull.h"
#include "lf/core/random.h"

namespace lf {
namespace {

const Aperture kOpenings[] = {{1, 0, 0}, {1, 3, 0.3}, {1, 5, 0}, {1, 8, 0.1}};

double Sum(const std::vector<double>& shares) {
  return std::accumulate(shares.begin(), shares.end(), 0.0);
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

// Returns, for each point, the share of the opening's samples that are nearest to it.
std::vector<double> SharesBySampling(const std::vector<Vec2>& points, const Aperture& aperture,
                                     int samples) {
  std::vector<double> shares(points.size());
  for (const Vec2& sample : SampleLens(aperture, samples)) {
    const auto nearest =
        std::min_element(points.begin(), points.end(), [&](const Vec2& a, const Vec2& b) {
          return (a - sample).squaredNorm() < (b - sample).squaredNorm();
        });
    shares[static_cast<size_t>(nearest - points.begin())] += 1.0 / samples;
  }
  return shares;
}

TEST(CellShares, OnePointStandsForTheWholeLensWhereverItIs) {
  for (const Aperture& aperture : kOpenings)
    for (const Vec2& point : {Vec2(0, 0), Vec2(0.9, 0), Vec2(30, -7)}) {
      const std::vector<double> shares = CellShares(std::vector{point}, aperture);
      ASSERT_EQ(shares.size(), 1u);
      EXPECT_NEAR(shares[0], 1, 1e-12);
    }
  EXPECT_TRUE(CellShares({}, kOpenings[0]).empty());
}

TEST(CellShares, CellsTileTheLens) {
  for (const Aperture& aperture : kOpenings)
    for (const size_t count : {2, 3, 7, 100, 3000})
      for (const double reach : {0.01, 1.0, 3.0}) {
        const auto points = RandomPoints(count, reach, count);
        const auto shares = CellShares(points, aperture);
        EXPECT_NEAR(Sum(shares), 1, 1e-11) << count << " within " << reach;
        for (const double share : shares) EXPECT_GE(share, -1e-13);
      }
}

TEST(CellShares, AreThoseOfTheNearestPoints) {
  constexpr int kSamples = 200000;
  for (const Aperture& aperture : kOpenings)
    for (const uint64_t seed : {1, 2, 3}) {
      // The density of the points is uneven: two thirds of them are in a corner.
      std::vector<Vec2> points = RandomPoints(20, 1.5, seed);
      for (const Vec2& p : RandomPoints(40, 0.4, seed + 9)) points.push_back(p + Vec2(0.6, 0.5));
      const auto shares = CellShares(points, aperture);
      const auto expected = SharesBySampling(points, aperture, kSamples);
      for (size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(shares[i], expected[i], 1e-3) << i;
    }
}

// Cells that lie within the opening are the same; those of points beside it are not lost.
TEST(WholeCellShares, AreNotClippedByTheOpening) {
  for (const Aperture& aperture : kOpenings) {
    std::vector<Vec2> points = RandomPoints(4000, 1.5, 1);
    points.push_back(points[7]);
    const auto whole = WholeCellShares(points, aperture, CoveredRegion(points, 0));
    const auto clipped = CellShares(points, aperture);
    const ApertureTest opening(aperture);
    EXPECT_NEAR(Sum(whole) * Area(aperture), ConvexPolygon(ConvexHull(points)).Area(), 1e-10);
    EXPECT_EQ(whole[7], whole.back());
    double inside = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      EXPECT_GE(whole[i], clipped[i] - 1e-12);
      if (points[i].norm() < 0.3) {
        EXPECT_NEAR(whole[i], clipped[i], 1e-12);
      }
      if (opening.Contains(points[i])) inside += whole[i];
    }
    EXPECT_NEAR(inside, 1, 0.02);
  }
}

// Cells beside a gap are larger than the square that cells are first cut from, and cells at the
// edge of the covered region are cut by it.
TEST(WholeCellShares, LargeCellsAreWholeToo) {
  std::vector<Vec2> points = RandomPoints(3000, 0.5, 2);
  for (const Vec2& point : RandomPoints(300, 3, 3)) points.push_back(point);
  for (const CoveredRegion& covered : {CoveredRegion(points, 0), CoveredRegion(points, 0.4)}) {
    const Aperture wide = {100, 4, 0};  // contains the covered region
    const auto whole = WholeCellShares(points, wide, covered);
    const auto clipped = CellShares(points, wide, covered);
    double most = 0;
    for (const Vec2& point : points) most = std::max(most, point.norm());
    for (size_t i = 0; i < points.size(); ++i) {
      if (points[i].norm() > 0.5 * most) continue;
      EXPECT_NEAR(whole[i] * Area(wide), clipped[i] * Area(wide), 1e-11) << i;
    }
  }
}

TEST(CellShares, InTheMiddleOfAGridTheyAreItsSquares) {
  std::vector<Vec2> points;
  for (int y = -12; y <= 12; ++y)
    for (int x = -12; x <= 12; ++x) points.emplace_back(0.1 * x, 0.1 * y);
  for (const Aperture& aperture : kOpenings) {
    const auto shares = CellShares(points, aperture);
    for (size_t i = 0; i < points.size(); ++i) {
      const double distance = points[i].norm();
      if (distance >= 0.35 && distance <= 1.08) continue;
      EXPECT_NEAR(shares[i] * Area(aperture), distance < 1 ? 0.01 : 0, 1e-12)
          << points[i].transpose();
    }
  }
  // Half of the square around the camera at (1, 0) is in the disk, without the part beyond the rim.
  const auto shares = CellShares(points, kOpenings[0]);
  const double half_chord = 0.05, rim = std::asin(half_chord) + half_chord * std::sqrt(1 - 0.0025);
  EXPECT_NEAR(shares[12 * 25 + 22] * kPi, rim - 0.95 * 0.1, 1e-12);
}

TEST(CellShares, PointsAtOnePlaceShareTheirCell) {
  std::vector<Vec2> points = RandomPoints(50, 1, 4);
  const auto single = CellShares(points, kOpenings[0]);
  for (int i = 0; i < 3; ++i) points.push_back(points[17]);
  const auto shared = CellShares(points, kOpenings[0]);
  for (size_t i = 0; i < 50; ++i)
    EXPECT_NEAR(shared[i], i == 17 ? single[i] / 4 : single[i], 1e-12);
  for (size_t i = 50; i < 53; ++i) EXPECT_NEAR(shared[i], single[17] / 4, 1e-12);
  const std::vector<Vec2> all_the_same(5, Vec2(0.2, 0.1));
  for (const double share : CellShares(all_the_same, kOpenings[2])) EXPECT_NEAR(share, 0.2, 1e-12);
}

// An exposure bracket is several LF images of one pose.
TEST(CellShares, EveryImageOfABracketHasAnEqualPartOfTheCell) {
  const std::vector<Vec2> points = RandomPoints(40, 1.2, 5);
  std::vector<Vec2> brackets;
  for (int exposure = 0; exposure < 3; ++exposure)
    brackets.insert(brackets.end(), points.begin(), points.end());
  for (const Aperture& aperture : kOpenings) {
    const auto single_cells = CellShares(points, aperture), cells = CellShares(brackets, aperture);
    const auto single_hats = HatShares(points, aperture), hats = HatShares(brackets, aperture);
    for (size_t i = 0; i < brackets.size(); ++i) {
      EXPECT_NEAR(cells[i], single_cells[i % points.size()] / 3, 1e-12);
      EXPECT_NEAR(hats[i], hats[i % points.size()], 1e-12);
      // The reach of hats beyond the outer cameras depends slightly on the number of points.
      EXPECT_NEAR(hats[i], single_hats[i % points.size()] / 3, 1e-3);
    }
  }
}

TEST(CellShares, CamerasOnALineCutTheLensIntoStrips) {
  for (const Vec2& along : {Vec2(1, 0), Vec2(0, 1), Vec2(0.6, 0.8)}) {
    std::vector<Vec2> points;
    for (int i = -30; i <= 30; ++i) points.emplace_back(0.05 * i * along);
    const auto shares = CellShares(points, kOpenings[0]);
    // The area between two chords is the difference of the areas on one side of them.
    const auto below = [](double d) { return std::asin(d) + d * std::sqrt(1 - d * d); };
    for (int i = -19; i <= 19; ++i)
      EXPECT_NEAR(shares[static_cast<size_t>(i + 30)] * kPi,
                  below(0.05 * i + 0.025) - below(0.05 * i - 0.025), 1e-12);
  }
}

TEST(CellShares, AreTheSameInAnyUnit) {
  const auto points = RandomPoints(80, 1.2, 11);
  const auto shares = CellShares(points, kOpenings[1]);
  for (const double unit : {1e-6, 1e6}) {
    std::vector<Vec2> scaled;
    for (const Vec2& p : points) scaled.push_back(unit * p);
    const auto scaled_shares = CellShares(scaled, {unit, 3, 0.3});
    for (size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(scaled_shares[i], shares[i], 1e-11);
  }
}

constexpr Aperture kPinhole = {0, 0, 0};

// Returns the mean of the points, weighted by their shares: the position from which the picture
// appears to be seen.
Vec2 MeanPlace(const std::vector<double>& shares, const std::vector<Vec2>& points) {
  Vec2 mean = Vec2::Zero();
  for (size_t i = 0; i < points.size(); ++i) mean += shares[i] * points[i];
  return mean;
}

std::vector<Vec2> Moved(std::vector<Vec2> points, const Vec2& by) {
  for (Vec2& p : points) p += by;
  return points;
}

// Tests the local coordinate property of Sibson's natural neighbours, which other hat functions
// lack.
TEST(HatShares, APinholeAmongCamerasIsSeenFromItsOwnPlace) {
  for (uint64_t seed = 1; seed < 40; ++seed) {
    const auto points = RandomPoints(300, 1, seed);
    const auto shares = HatShares(points, kPinhole);
    EXPECT_NEAR(Sum(shares), 1, 1e-12);
    EXPECT_NEAR(MeanPlace(shares, points).norm(), 0, 1e-9) << seed;
    const auto used =
        std::count_if(shares.begin(), shares.end(), [](double share) { return share > 1e-9; });
    EXPECT_GE(used, 3);
    EXPECT_LE(used, 12);
    for (const double share : shares) EXPECT_GE(share, 0);
  }
}

TEST(HatShares, APinholeAtACameraIsThatCamera) {
  auto points = RandomPoints(100, 1, 3);
  points[40] = Vec2::Zero();
  EXPECT_NEAR(HatShares(points, kPinhole)[40], 1, 1e-12);
  points[41] = points[42] = points[40];
  for (const size_t i : {40, 41, 42}) EXPECT_NEAR(HatShares(points, kPinhole)[i], 1.0 / 3, 1e-12);
  // A pinhole close to a camera has almost only the weight of that camera.
  for (const double distance : {1e-9, 1e-6, 1e-4}) {
    const auto near = HatShares(Moved(points, {distance, 0}), kPinhole);
    EXPECT_NEAR(near[40] + near[41] + near[42], 1, 100 * distance);
  }
}

TEST(HatShares, PointsAtOnePlaceShareWhatOneWouldTake) {
  auto points = RandomPoints(100, 1, 3);
  const auto alone = HatShares(points, kPinhole);
  const size_t largest =
      static_cast<size_t>(std::max_element(alone.begin(), alone.end()) - alone.begin());
  EXPECT_GT(alone[largest], 0.1);
  points.push_back(points[largest]);
  points.push_back(points[largest]);
  const auto shares = HatShares(points, kPinhole);
  for (size_t i = 0; i < alone.size(); ++i)
    EXPECT_NEAR(shares[i], i == largest ? alone[i] / 3 : alone[i], 1e-12) << i;
  for (const size_t twin : {100, 101}) EXPECT_NEAR(shares[twin], alone[largest] / 3, 1e-12);
}

TEST(HatShares, OnAGridTheyAreSymmetric) {
  std::vector<Vec2> points;
  for (int y = -4; y < 4; ++y)
    for (int x = -4; x < 4; ++x) points.emplace_back(x + 0.5, y + 0.5);
  const auto middle = HatShares(points, kPinhole);
  for (const size_t i : {27, 28, 35, 36}) EXPECT_NEAR(middle[i], 0.25, 1e-12);
  const auto beside = HatShares(Moved(points, {0, 0.5}), kPinhole);
  EXPECT_NEAR(beside[27], beside[28], 1e-12);
  // the new cell has area 9/16; it takes 1/4 from each of these two
  EXPECT_NEAR(beside[27], 4.0 / 9, 1e-12);
}

TEST(HatShares, MoveSmoothlyWithTheLens) {
  const auto points = RandomPoints(60, 1, 5);
  std::vector<double> before = HatShares(Moved(points, {-0.3, 0.1}), kPinhole);
  for (int step = 1; step <= 2000; ++step) {
    const auto now = HatShares(Moved(points, {-0.3 + 3e-4 * step, 0.1}), kPinhole);
    for (size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(now[i], before[i], 0.02);
    before = now;
  }
}

TEST(HatShares, OfAnOpeningAreTheMeanOverIt) {
  const auto points = RandomPoints(30, 1, 6);
  for (const Aperture& aperture : kOpenings) {
    std::vector<double> mean(points.size(), 0);
    for (const Vec2& place : SampleLens(aperture, 16)) {
      const auto there = HatShares(Moved(points, -place), kPinhole);
      for (size_t i = 0; i < mean.size(); ++i) mean[i] += there[i] / 16;
    }
    const auto shares = HatShares(points, aperture, 16);
    for (size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(shares[i], mean[i], 1e-12);
  }
}

TEST(HatShares, OfManyCamerasAreNearlyTheirCells) {
  std::vector<Vec2> points;
  for (int y = -12; y <= 12; ++y)
    for (int x = -12; x <= 12; ++x) points.emplace_back(0.1 * x, 0.1 * y);
  const auto cells = CellShares(points, kOpenings[0]);
  const auto hats = HatShares(points, kOpenings[0], 20000);
  for (size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(hats[i], cells[i], points[i].norm() < 0.8 ? 0.05 * cells[i] : 0.003) << i;
}

TEST(HatShares, BesideAllCamerasTheNearestOnesShare) {
  const auto points = RandomPoints(50, 1, 7);
  for (const Vec2& away : {Vec2(1.5, 0), Vec2(40, 3), Vec2(-1e4, 1e4)}) {
    const auto shares = HatShares(Moved(points, away), kPinhole);
    EXPECT_NEAR(Sum(shares), 1, 1e-12);
    for (const double share : shares) EXPECT_GE(share, 0);
  }
  const std::vector<Vec2> two = {{1, 0}, {-1, 0}};
  for (const double share : HatShares(two, kPinhole)) EXPECT_NEAR(share, 0.5, 1e-12);
  EXPECT_NEAR(HatShares(std::vector{Vec2(3, 4)}, kOpenings[1])[0], 1, 1e-12);
  EXPECT_TRUE(HatShares({}, kPinhole).empty());
}

TEST(SpreadShares, APlaceIsDividedByAGaussian) {
  const std::vector<Vec2> points = {{0, 0}, {1, 0}, {0, -1}, {1, 0}};
  const std::vector<LensPlace> places = {{{0.2, 1}, 3}, {{0.2, 1}, 1}};
  const auto shares = SpreadShares(points, places, 0.7);
  EXPECT_NEAR(Sum(shares), 1, 1e-12);
  for (size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(
        shares[i] / shares[0],
        std::exp((places[0].place.squaredNorm() - (points[i] - places[0].place).squaredNorm()) /
                 (2 * 0.7 * 0.7)),
        1e-12);
}

TEST(SpreadShares, FarBeyondThePointsTheNearestTakesAll) {
  const std::vector<Vec2> points = {{0, 0}, {1, 0}, {0, 1}};
  const auto shares = SpreadShares(points, std::vector<LensPlace>{{{0, -500}}, {{400, 0}, 3}}, 0.5);
  const double second = std::exp(-1 / (2 * 0.5 * 0.5));  // at (0, -500), of (1, 0)
  EXPECT_NEAR(shares[0], 0.25 / (1 + second), 1e-12);
  EXPECT_NEAR(shares[1], 0.75 + 0.25 * second / (1 + second), 1e-12);
  EXPECT_EQ(shares[2], 0);
  EXPECT_EQ(Sum(SpreadShares(points, {}, 0.5)), 0);
  EXPECT_TRUE(SpreadShares({}, std::vector<LensPlace>{{}}, 0.5).empty());
}

}  // namespace
}  // namespace lf
