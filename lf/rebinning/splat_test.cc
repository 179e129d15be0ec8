// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/splat.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr double kLensRadius = 0.004;

std::vector<FrameRay> RandomFrameRays(size_t count, int width, int height, uint64_t seed) {
  RandomSequence random(seed);
  std::vector<FrameRay> rays(count);
  for (FrameRay& ray : rays) {
    ray.lens_x_w = static_cast<float>(random.Uniform(-1.2 * kLensRadius, 1.2 * kLensRadius));
    ray.lens_y_w = static_cast<float>(random.Uniform(-1.2 * kLensRadius, 1.2 * kLensRadius));
    ray.x_px = static_cast<float>(random.Uniform(-2, width + 2));
    ray.y_px = static_cast<float>(random.Uniform(-2, height + 2));
    for (float& value : ray.rgb) value = static_cast<float>(random.Uniform(0, 65535));
  }
  return rays;
}

// Returns the sums of Eq. 4.5, added up ray by ray.
QuerySum BruteForce(std::span<const FrameRay> rays, const Vec2& lens_point, const Vec2& position,
                    const QueryKernel& kernel) {
  QuerySum sum;
  for (const FrameRay& ray : rays) {
    const double st2 = (Vec2(ray.lens_x_w, ray.lens_y_w) - lens_point).squaredNorm() /
                       (kernel.sigma_st_w * kernel.sigma_st_w);
    const double uv2 = (Vec2(ray.x_px, ray.y_px) - position).squaredNorm() /
                       (kernel.sigma_uv_px * kernel.sigma_uv_px);
    if (st2 + uv2 > kReach_sigmas * kReach_sigmas) continue;
    const double weight = std::exp(-(st2 + uv2) / 2);
    sum.weight += weight;
    for (int c = 0; c < 3; ++c) sum.rgb[c] += weight * ray.rgb[c];
  }
  return sum;
}

TEST(RayQuery, IsBruteForce) {
  const std::vector<FrameRay> rays = RandomFrameRays(20000, 60, 40, 1);
  const QueryKernel kernel{0.0008, 0.9};
  const RayQuery query(rays, kernel);
  RandomSequence random(2);
  for (int i = 0; i < 300; ++i) {
    const Vec2 lens_point(random.Uniform(-kLensRadius, kLensRadius),
                          random.Uniform(-kLensRadius, kLensRadius));
    const Vec2 position(random.Uniform(0, 60), random.Uniform(0, 40));
    const QuerySum expected = BruteForce(rays, lens_point, position, kernel);
    const QuerySum found = query.WithinReach(lens_point, position);
    EXPECT_NEAR(found.weight, expected.weight,
                0.012 + 1e-4 * expected.weight);  // a ray may lie on the rim of the reach
    if (expected.weight < 1) continue;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found.rgb[c] / found.weight, expected.rgb[c] / expected.weight, 700);
  }
}

TEST(RayQuery, TheNearestAreThoseOfBruteForce) {
  const std::vector<FrameRay> rays = RandomFrameRays(500, 30, 30, 3);
  const QueryKernel kernel{0.001, 1.5};
  const RayQuery query(rays, kernel);
  const Vec2 lens_point(0.001, -0.002), position(11.2, 14.9);
  // The rays.size() nearest rays are all rays, at any distance.
  double weight = 0, red = 0, least = 1e30;
  const auto distance2 = [&](const FrameRay& ray) {
    return (Vec2(ray.lens_x_w, ray.lens_y_w) - lens_point).squaredNorm() / 1e-6 +
           (Vec2(ray.x_px, ray.y_px) - position).squaredNorm() / 2.25;
  };
  for (const FrameRay& ray : rays) least = std::min(least, distance2(ray));
  for (const FrameRay& ray : rays) {
    weight += std::exp(-(distance2(ray) - least) / 2);
    red += std::exp(-(distance2(ray) - least) / 2) * ray.rgb[0];
  }
  const QuerySum all = query.Nearest(lens_point, position, rays.size());
  EXPECT_NEAR(all.rgb[0] / all.weight, red / weight, 1);
  // The nearest ray alone, at any distance.
  const QuerySum one = query.Nearest(lens_point, position, 1);
  EXPECT_EQ(one.weight, 1);
  const auto nearest = std::min_element(
      rays.begin(), rays.end(),
      [&](const FrameRay& a, const FrameRay& b) { return distance2(a) < distance2(b); });
  EXPECT_EQ(one.rgb[2], nearest->rgb[2]);
  EXPECT_GT(query.Nearest(Vec2(3, 3), Vec2(1000, 1000), 4).weight, 0);
}

// Expects equal frames, except for elements with a ray on the rim of the reach.
void ExpectSameFrame(const SplatFrame& fast, const SplatFrame& judge) {
  double sum2 = 0;
  size_t count = 0, differing = 0;
  for (int y = 0; y < fast.share.height(); ++y)
    for (int x = 0; x < fast.share.width(); ++x) {
      if (std::abs(fast.share.at(x, y) - judge.share.at(x, y)) > 1e-5) {
        ++differing;
        continue;
      }
      for (int c = 0; c < 3; ++c, ++count) {
        const double difference = fast.rgb.at(x, y, c) - judge.rgb.at(x, y, c);
        sum2 += difference * difference;
      }
    }
  ASSERT_GT(count, fast.rgb.pixels().size() * 9 / 10);
  EXPECT_LT(differing, 25u);
  EXPECT_LT(std::sqrt(sum2 / static_cast<double>(count)), 65535 * 0.1 / 255);
}

TEST(Splat, IsWhatQueriesGive) {
  constexpr int kWidth = 150, kHeight = 71;
  const std::vector<FrameRay> rays = RandomFrameRays(60000, kWidth, kHeight, 4);
  ThreadPool pool(2);
  for (const int k : {1, 2, 3})
    for (const int blades : {0, 5})
      for (const double radius : {kLensRadius, 0.0002, 0.0}) {
        const Aperture aperture{radius, blades, 0.2};
        const LensPointSets points = MakeLensPoints(aperture, 7, k, 9);
        const QueryKernel kernel{0.0005, 0.8};
        const SplatFrame fast = Splat(rays, kWidth, kHeight, points, kernel, pool);
        const SplatFrame judge = SplatReference(rays, kWidth, kHeight, points, kernel, pool);
        ExpectSameFrame(fast, judge);
      }
}

// Some lens points have a larger spread, and the plate queries them in part: shares rise from the
// left to the right edge, and are 0 for some points.
TEST(Splat, PointsMayReachFartherAndBeAskedForInPart) {
  constexpr int kWidth = 140, kHeight = 67;
  const std::vector<FrameRay> rays = RandomFrameRays(40000, kWidth, kHeight, 6);
  ThreadPool pool(2);
  for (const int k : {1, 2}) {
    LensPointSets points = MakeLensPoints({kLensRadius, 0, 0}, 11, k, 9);
    RandomSequence random(7);
    PointShares shares{NodeAxis(kWidth, 2), NodeAxis(kHeight, 3), points.point_count(), {}};
    for (const auto& set : points.sets) {
      points.spreads.emplace_back();
      for (size_t i = 0; i < set.size(); ++i)
        points.spreads.back().push_back(i % 3 == 0 ? 1.75 : 1);
    }
    for (size_t node = 0; node < shares.node_count(); ++node)
      for (size_t i = 0; i < shares.point_count; ++i)
        shares.values.push_back(
            i % 5 == 4 || (i % 5 == 3 && node % 2 == 0) ? 0 : static_cast<float>(node % 2));
    const QueryKernel kernel{0.0005, 0.8};
    const SplatFrame fast = Splat(rays, kWidth, kHeight, points, kernel, pool, &shares);
    ExpectSameFrame(fast, SplatReference(rays, kWidth, kHeight, points, kernel, pool, &shares));
    EXPECT_LT(fast.share.at(0, 30), 0.02);
    EXPECT_GT(fast.share.at(kWidth - 1, 30), 0.7);
    EXPECT_LT(fast.share.at(kWidth - 1, 30), 0.9);
  }
}

TEST(Splat, IsTheSameForAnyNumberOfThreads) {
  const std::vector<FrameRay> rays = RandomFrameRays(30000, 200, 90, 5);
  const LensPointSets points = MakeLensPoints({kLensRadius, 6, 0}, 9, 2, 1);
  ThreadPool one(1), three(3);
  const SplatFrame a = Splat(rays, 200, 90, points, {0.0006, 0.7}, one);
  const SplatFrame b = Splat(rays, 200, 90, points, {0.0006, 0.7}, three);
  EXPECT_EQ(a.rgb.pixels(), b.rgb.pixels());
  EXPECT_EQ(a.share.pixels(), b.share.pixels());
}

// One ray through the lens centre becomes a spot of its colour at its position on the plate. Two of
// the four lens points are near it.
TEST(Splat, ARayIsASpot) {
  FrameRay ray;
  ray.x_px = 20.5F;
  ray.y_px = 10.5F;
  ray.rgb = {100, 200, 300};
  LensPointSets points;
  points.sets = {{Vec2(0, 0), Vec2(1, 0), Vec2(0, -1), Vec2(0.1, 0.1)}};
  ThreadPool pool(1);
  const SplatFrame frame = Splat(std::span(&ray, 1), 40, 30, points, {0.2, 1}, pool);
  EXPECT_EQ(frame.share.at(20, 10), 0.5F);
  EXPECT_FLOAT_EQ(frame.rgb.at(20, 10, 2), 300);
  EXPECT_FLOAT_EQ(frame.rgb.at(21, 10, 1), 200);
  EXPECT_EQ(frame.share.at(20, 14), 0);
  EXPECT_EQ(frame.rgb.at(20, 14, 0), 0);
}

TEST(Splat, LensPointsOfSetsAreDifferentAndInTheOpening) {
  const Aperture aperture{kLensRadius, 5, 0.3};
  const LensPointSets points = MakeLensPoints(aperture, 16, 2, 3);
  ASSERT_EQ(points.sets.size(), 4u);
  std::vector<Vec2> all;
  for (const auto& set : points.sets) {
    EXPECT_EQ(set.size(), 16u);
    Vec2 mean = Vec2::Zero();
    for (const Vec2& point : set) {
      EXPECT_TRUE(Contains(aperture, point));
      for (const Vec2& other : all) EXPECT_GT((other - point).norm(), 1e-6);
      all.push_back(point);
      mean += point / 16;
    }
    EXPECT_LT(mean.norm(), 0.2 * kLensRadius);
  }
  EXPECT_EQ(MakeLensPoints({0, 0, 0}, 16, 2, 3).sets, std::vector<std::vector<Vec2>>{{Vec2(0, 0)}});
}

}  // namespace
}  // namespace lf
