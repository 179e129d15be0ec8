// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/core/quintic.h"
#include "lf/core/random.h"

namespace lf {
namespace {

bool HasParabolas(const Polynomials& polynomials, int width) {
  return AllowParabolas(polynomials, 0.5 * width);
}

// Returns the largest difference between a coordinate on a piece of `width` positions and the
// parabolas that kernels compute: they have the value and the curvature of the polynomial in their
// middle, and a slope to which the third power adds.
double LargestDifference(const double (&c)[Segment::kTerms], int width) {
  double largest = 0;
  for (int begin = 0; begin < width; begin += Segment::kParabola) {
    const double t = begin + 0.5 * Segment::kParabola - 0.5 * width;
    const double value = QuinticAt(c, t);
    const double slope = (((5 * c[5] * t + 4 * c[4]) * t + 3 * c[3]) * t + 2 * c[2]) * t + c[1];
    const double bend = ((10 * c[5] * t + 6 * c[4]) * t + 3 * c[3]) * t + c[2];
    const double third = (10 * c[5] * t + 4 * c[4]) * t + c[3];
    for (double j = -7.5; j <= 7.5; ++j) {
      const double parabola = value + (slope + 0.75 * 7.5 * 7.5 * third) * j + bend * j * j;
      largest = std::max(largest, std::abs(QuinticAt(c, t + j) - parabola));
    }
  }
  return largest;
}

TEST(Segment, ParabolasAreAsAccurateAsStated) {
  RandomSequence random(1);
  int with = 0, without = 0;
  for (int i = 0; i < 3000; ++i) {
    const int width = 16 << (i % 7);
    const double half = 0.5 * width;
    // Powers whose parts at the ends of the piece are up to 10 elements, down to 10^-7.
    Polynomials polynomials = {{random.Uniform(0, 900), 1}, {random.Uniform(0, 900), 0.01}};
    for (int power = 2; power < Segment::kTerms; ++power)
      for (double* const c : {&polynomials.x[power], &polynomials.y[power]})
        *c = random.Uniform(-10, 10) * std::pow(10, random.Uniform(-8, 0)) / std::pow(half, power);
    const double difference =
        std::max(LargestDifference(polynomials.x, width), LargestDifference(polynomials.y, width));
    const bool has_parabolas = HasParabolas(polynomials, width);
    (has_parabolas ? with : without) += 1;
    if (has_parabolas) {
      EXPECT_LE(difference, Segment::kParabolaTolerance * (1 + 1e-6)) << i;
    } else {
      EXPECT_GT(difference, Segment::kParabolaTolerance / 100) << i;
    }
  }
  EXPECT_GT(with, 300);
  EXPECT_GT(without, 300);
}

TEST(Segment, CubicsHaveParabolasUpToTheTolerance) {
  constexpr double kLargest = 4 * Segment::kParabolaTolerance / (7.5 * 7.5 * 7.5);
  EXPECT_TRUE(HasParabolas({{0, 1, 1e-4, 0.99 * kLargest}, {}}, 1024));
  EXPECT_TRUE(HasParabolas({{}, {0, 1, 1e-4, -0.99 * kLargest}}, 1024));
  EXPECT_FALSE(HasParabolas({{0, 1, 1e-4, 1.01 * kLargest}, {}}, 1024));
  EXPECT_FALSE(HasParabolas({{}, {0, 1, 1e-4, -1.01 * kLargest}}, 1024));
}

TEST(Segment, PerspectiveHasParabolasUnlessItIsStrong) {
  const auto has_parabolas = [](double q) {
    std::vector<Segment> segments;
    SegmentMaker({1, 0, 0}, {0, 1, 0}, {q, 0, 1}).Add(3, 20, 600, &segments);
    EXPECT_FALSE(segments.empty());
    return std::all_of(segments.begin(), segments.end(),
                       [](const Segment& s) { return s.has_parabolas; });
  };
  EXPECT_TRUE(has_parabolas(0));
  EXPECT_TRUE(has_parabolas(2e-5));
  EXPECT_FALSE(has_parabolas(1e-3));
}

TEST(Segment, PiecesShorterThanAParabolaHaveNone) {
  EXPECT_TRUE(HasParabolas({{5, 1}, {5}}, 16));
  EXPECT_FALSE(HasParabolas({{5, 1}, {5}}, 8));
}

}  // namespace
}  // namespace lf
