// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/plane_warp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

PinholeView ViewAt(const Vec3& centre, const Mat3& rotation, double focal_length_px = 500) {
  PinholeView view;
  view.intrinsics << focal_length_px, 0, 320, 0, focal_length_px, 240, 0, 0, 1;
  view.cam_from_world.rotation = rotation;
  view.cam_from_world.translation = -(rotation * centre);
  return view;
}

Mat3 AnyRotation(RandomSequence& random, double most_rad) {
  const Vec3 axis(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
  return Eigen::AngleAxisd(random.Uniform(0, most_rad), axis.normalized()).toRotationMatrix();
}

double InverseDepthAt(const InverseDepthRange& depths, int depth) {
  return depths.least + depth * (depths.greatest - depths.least) / (kDepthSteps - 1);
}

// Projects a point of each plane into both cameras, in double precision.
TEST(PlaneWarp, PointsOfThePlanesAreFound) {
  RandomSequence random(1);
  const InverseDepthRange depths = {0.02, 0.5};
  for (int i = 0; i < 2000; ++i) {
    const PinholeView target = ViewAt(Vec3::Zero(), AnyRotation(random, 3));
    PinholeView reference =
        ViewAt({random.Uniform(-.3, .3), random.Uniform(-.3, .3), random.Uniform(-.3, .3)},
               AnyRotation(random, 0.2), random.Uniform(300, 800));
    reference.cam_from_world.rotation *= target.cam_from_world.rotation;
    const std::optional<PlaneWarp> warp = MakePlaneWarp(target, reference, depths);
    ASSERT_TRUE(warp.has_value());
    EXPECT_TRUE(IsWithinLimits(*warp));
    const int x = static_cast<int>(random.Uniform(0, 640)),
              y = static_cast<int>(random.Uniform(0, 480));
    const int depth = static_cast<int>(random.Uniform(0, kDepthSteps));
    const Vec3 ray = target.intrinsics.inverse() * Vec3(x + 0.5, y + 0.5, 1);
    const Vec3 point = ray / InverseDepthAt(depths, depth);
    const Vec3 image = reference.intrinsics *
                       (reference.cam_from_world * (target.cam_from_world.Inverse() * point));
    const WarpedPosition found = Warped(*warp, depth, x, y);
    EXPECT_NEAR(found.x / 1024.0, image.x() / image.z() - 0.5, 2e-3);
    EXPECT_NEAR(found.y / 1024.0, image.y() / image.z() - 0.5, 2e-3);
  }
}

// A camera to the right sees points farther to the left, by the disparity f b / z.
TEST(PlaneWarp, ParallelCamerasShift) {
  const InverseDepthRange depths = {0, 0.63};
  const auto warp = MakePlaneWarp(ViewAt({0, 0, 0}, Mat3::Identity()),
                                  ViewAt({0.1, 0, 0}, Mat3::Identity()), depths);
  ASSERT_TRUE(warp.has_value());
  for (int depth = 0; depth < kDepthSteps; ++depth)
    for (const int x : {-16, 0, 17, 639}) {
      const int disparity = static_cast<int>(std::lround(1024 * 500 * 0.1 * depth / 100.0));
      EXPECT_NEAR(Warped(*warp, depth, x, 5).x, 1024 * x - disparity, 1);
      EXPECT_EQ(Warped(*warp, depth, x, 5).y, 1024 * 5);
      // All pixels have the same displacement.
      EXPECT_EQ(Warped(*warp, depth, x, 5).x - 1024 * x, Warped(*warp, depth, 0, 300).x);
    }
}

TEST(PlaneWarp, HalvedPicturesMoveByHalf) {
  const PinholeView target = ViewAt({0, 0, 0}, Mat3::Identity());
  const PinholeView reference = ViewAt({0.1, 0.05, 0}, Mat3::Identity());
  const auto whole = MakePlaneWarp(target, reference, {0, 1});
  const auto half = MakePlaneWarp(Halved(target), Halved(reference), {0, 1});
  ASSERT_TRUE(whole && half);
  const WarpedPosition moved = Warped(*whole, 40, 200, 100), halved = Warped(*half, 40, 100, 50);
  EXPECT_NEAR(halved.x - 100 * 1024, (moved.x - 200 * 1024) / 2, 1);
  EXPECT_NEAR(halved.y - 50 * 1024, (moved.y - 100 * 1024) / 2, 1);
}

TEST(PlaneWarp, TheIdentityMovesNothing) {
  EXPECT_EQ(Warped(IdentityWarp(), 63, 32767, -64), (WarpedPosition{32767 * 1024, -64 * 1024}));
}

TEST(PlaneWarp, PixelsBehindTheReferenceStay) {
  PlaneWarp warp = IdentityWarp();
  warp.far[2][2] = -warp.far[2][2];
  EXPECT_EQ(Warped(warp, 0, 12, 34), (WarpedPosition{12 * 1024, 34 * 1024}));
}

TEST(PlaneWarp, CamerasFarApartHaveNone) {
  PinholeView far = ViewAt({1e12, 0, 0}, Mat3::Identity());
  EXPECT_FALSE(MakePlaneWarp(ViewAt({0, 0, 0}, Mat3::Identity()), far, {0, 1}));
  far.cam_from_world.translation = Vec3::Constant(std::nan(""));
  EXPECT_FALSE(MakePlaneWarp(ViewAt({0, 0, 0}, Mat3::Identity()), far, {0, 1}));
}

// The largest numbers within the limits do not overflow: a sanitizer would tell, and the position
// is that of the quotient of 128-bit integers.
TEST(PlaneWarp, AnyWarpWithinTheLimitsIsComputed) {
  RandomSequence random(2);
  const auto any = [&](int64_t most) {
    const double exponent = random.Uniform(0, 1) < 0.3 ? 0 : random.Uniform(-40, 0);
    const auto value = static_cast<int64_t>(std::exp2(exponent) * static_cast<double>(most));
    return random.Uniform(0, 1) < 0.5 ? -value : value;
  };
  for (int i = 0; i < 100000; ++i) {
    PlaneWarp warp;
    for (int row = 0; row < 3; ++row) {
      warp.far[row] = {any(kMostSlope), any(kMostSlope), any(kMostOrigin)};
      warp.step[row] = any(kMostStep);
    }
    ASSERT_TRUE(IsWithinLimits(warp));
    const int x = i % 3 == 0 ? kMostPredictedSide + 64 : static_cast<int>(random.Uniform(-64, 40));
    const int y = i % 5 == 0 ? kMostPredictedSide + 64 : static_cast<int>(random.Uniform(-64, 40));
    const int depth = i % kDepthSteps;
    const auto row = [&](int j) {
      return static_cast<__int128>(warp.far[j][0]) * x + static_cast<__int128>(warp.far[j][1]) * y +
             warp.far[j][2] + static_cast<__int128>(warp.step[j]) * depth;
    };
    const __int128 w = row(2);
    const auto expected = [&](int j, int stay) -> int64_t {
      if (w <= 0) return int64_t{stay} * 1024;
      const __int128 u = row(j) * 1024 + w / 2;
      __int128 quotient = u / w;
      if (u % w < 0) --quotient;
      const __int128 most = 1 << 26;
      return static_cast<int64_t>(quotient < -most ? -most : quotient > most ? most : quotient);
    };
    const WarpedPosition found = Warped(warp, depth, x, y);
    ASSERT_EQ(found.x, expected(0, x));
    ASSERT_EQ(found.y, expected(1, y));
  }
  PlaneWarp beyond = IdentityWarp();
  beyond.step[1] = kMostStep + 1;
  EXPECT_FALSE(IsWithinLimits(beyond));
}

}  // namespace
}  // namespace lf
