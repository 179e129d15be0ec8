// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/interpolation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

double At(const std::vector<double>& knots, const std::vector<double>& values, double knot) {
  const std::vector<double> slopes = MonotoneSlopes(knots, values);
  size_t i = 0;
  while (i + 2 < knots.size() && knots[i + 1] < knot) ++i;
  return CubicHermite(knot, knots[i], knots[i + 1], values[i], values[i + 1], slopes[i],
                      slopes[i + 1]);
}

TEST(MonotoneCubic, NeverLeavesTheRangeOfTheTwoValuesAround) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    std::vector<double> knots{0}, values{RandomUnit(seed, 0, 1)};
    for (uint64_t i = 1; i < 8; ++i) {
      knots.push_back(knots.back() + 0.01 + RandomUnit(seed, i, 0));
      values.push_back(std::pow(RandomUnit(seed, i, 1), 4));
    }
    for (size_t i = 0; i + 1 < knots.size(); ++i) {
      const auto [low, high] = std::minmax(values[i], values[i + 1]);
      for (int step = 0; step <= 20; ++step) {
        const double knot = knots[i] + (knots[i + 1] - knots[i]) * step / 20;
        EXPECT_GE(At(knots, values, knot), low - 1e-12);
        EXPECT_LE(At(knots, values, knot), high + 1e-12);
      }
    }
  }
}

TEST(MonotoneCubic, ReproducesAStraightLine) {
  const std::vector<double> knots{0, 1, 1.5, 4}, values{1, 3, 4, 9};
  for (const double knot : {0.3, 1.2, 2.0, 3.9})
    EXPECT_NEAR(At(knots, values, knot), 1 + 2 * knot, 1e-12);
}

TEST(MonotoneCubic, IsFlatAtAPeak) {
  const std::vector<double> slopes =
      MonotoneSlopes(std::vector<double>{0, 1, 3}, std::vector<double>{0, 5, 2});
  EXPECT_EQ(slopes[1], 0);
}

TEST(MonotoneCubic, OfOneValueIsConstant) {
  EXPECT_EQ(MonotoneSlopes(std::vector<double>{2}, std::vector<double>{7}), std::vector<double>{0});
}

TEST(EasedHermite, HasThePolynomialsThatItStates) {
  const auto at = [](double x, double m, const Rests& rests) {
    return EasedHermite(2 + 5 * x, 2.0, 7.0, 0.0, 1.0, m / 5, m / 5, rests);
  };
  for (const double x : {0.0, 0.1, 0.25, 0.5, 0.8, 1.0})
    for (const double m : {0.0, 1.0, 2.0, 3.0}) {
      const double x3 = x * x * x, y = 1 - x;
      EXPECT_NEAR(at(x, m, {true, true}), 10 * x3 - 15 * x3 * x + 6 * x3 * x * x, 1e-14);
      EXPECT_NEAR(at(x, m, {true, false}), (4 - m) * x3 + (m - 3) * x3 * x, 1e-14);
      EXPECT_NEAR(at(x, m, {false, true}), 1 - (4 - m) * y * y * y - (m - 3) * y * y * y * y,
                  1e-14);
      EXPECT_EQ(at(x, m, {}), CubicHermite(2 + 5 * x, 2.0, 7.0, 0.0, 1.0, m / 5, m / 5));
    }
}

TEST(EasedHermite, StaysBetweenBothValuesToTheLastBit) {
  for (const Rests rests : {Rests{true, true}, Rests{true, false}, Rests{false, true}})
    for (const double m : {0.0, 0.4, 2.0, 3.0})
      for (int i = 0; i <= 100000; ++i) {
        const double x = i / 100000.0;
        const double closing = EasedHermite(x, 0.0, 1.0, 4.0, 0.0, -4 * m, -4 * m, rests);
        const double opening = EasedHermite(x, 0.0, 1.0, 0.0, 4.0, 4 * m, 4 * m, rests);
        ASSERT_GE(closing, 0) << x << " " << m;
        ASSERT_GE(opening, 0) << x << " " << m;
        ASSERT_LE(closing, 4 * (1 + 1e-15)) << x << " " << m;
        ASSERT_LE(opening, 4 * (1 + 1e-15)) << x << " " << m;
      }
}

TEST(CentripetalKnots, AreRootsOfTheDistances) {
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {4, 9, 0}, {4, 9, 0}};
  EXPECT_EQ(CentripetalKnots(points), (std::vector<double>{0, 2, 5, 5}));
}

TEST(CatmullRom, IsTheUniformSplineForEqualDistances) {
  // The chords are equally long, so the inner slope is the mean of their slopes.
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 0}};
  const std::vector<Vec3> slopes = CatmullRomSlopes(CentripetalKnots(points), points);
  EXPECT_NEAR((slopes[1] - Vec3(0.5, 0.5, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((slopes[0] - Vec3(1, 0, 0)).norm(), 0, 1e-12);
}

TEST(CatmullRom, AgreesWithTheBarryGoldmanPyramid) {
  const std::vector<Vec3> p{{0, 0, 0}, {1, 0.2, 0}, {1.3, 2, 0.4}, {5, 2, -1}};
  const std::vector<double> t = CentripetalKnots(p);
  const std::vector<Vec3> slopes = CatmullRomSlopes(t, p);
  for (const double share : {0.1, 0.5, 0.8}) {
    const double s = t[1] + share * (t[2] - t[1]);
    const auto mix = [&](const Vec3& a, const Vec3& b, double from, double to) -> Vec3 {
      return ((to - s) * a + (s - from) * b) / (to - from);
    };
    const Vec3 a1 = mix(p[0], p[1], t[0], t[1]), a2 = mix(p[1], p[2], t[1], t[2]);
    const Vec3 a3 = mix(p[2], p[3], t[2], t[3]);
    const Vec3 expected = mix(mix(a1, a2, t[0], t[2]), mix(a2, a3, t[1], t[3]), t[1], t[2]);
    const Vec3 found = CubicHermite<Vec3>(s, t[1], t[2], p[1], p[2], slopes[1], slopes[2]);
    EXPECT_NEAR((found - expected).norm(), 0, 1e-12);
  }
}

TEST(CatmullRom, RepeatedPointsShareOneSlope) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const std::vector<Vec3> slopes = CatmullRomSlopes(CentripetalKnots(points), points);
  EXPECT_NEAR((slopes[1] - Vec3(0.5, 0.5, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(slopes[1], slopes[2]);
}

TEST(Slerp, TurnsAtConstantSpeed) {
  const Eigen::AngleAxisd turn(RadiansFromDegrees(80), Vec3(1, 2, 3).normalized());
  const Eigen::Quaterniond a(Eigen::AngleAxisd(0.7, Vec3::UnitY()));
  const Eigen::Quaterniond b = a * Eigen::Quaterniond(turn);
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const Eigen::Quaterniond between = Slerp(a, b, share);
    EXPECT_NEAR(a.angularDistance(between), share * RadiansFromDegrees(80), 1e-9);
    EXPECT_NEAR(between.angularDistance(b), (1 - share) * RadiansFromDegrees(80), 1e-9);
  }
}

TEST(Slerp, TakesTheShorterArcWhateverTheSign) {
  const Eigen::Quaterniond a(Eigen::AngleAxisd(0.2, Vec3::UnitZ()));
  const Eigen::Quaterniond b(Eigen::AngleAxisd(0.6, Vec3::UnitZ()));
  const Eigen::Quaterniond minus_b(-b.w(), -b.x(), -b.y(), -b.z());
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
  EXPECT_NEAR(Slerp(a, minus_b, 0.5).angularDistance(expected), 0, 1e-9);
}

}  // namespace
}  // namespace lf
