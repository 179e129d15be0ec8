// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/point_subject.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

PinholeCamera Camera() {
  PinholeCamera camera;
  camera.intrinsics = {500, 500, 320, 240, 0, 640, 480};
  camera.cam_from_world = *LookAlong({1, -2, 3}, Vec3(0.3, 0.2, -1).normalized(), {0, 1, 0});
  return camera;
}

// Returns the depth of a point at position (x, y) of the image, each from -1 to 1. A negative depth
// puts the point behind the camera.
using Depth = std::function<double(RandomSequence* random, double x, double y)>;
// Draws points at random image positions.
std::vector<Vec3> Draw(int count, const Depth& depth) {
  const PinholeCamera camera = Camera();
  RandomSequence random(17);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.Uniform(-1, 1), y = random.Uniform(-1, 1);
    const double depth_w = depth(&random, x, y);
    points.push_back(camera.cam_from_world.Inverse() * (depth_w * Vec3(0.64 * x, 0.48 * y, 1)));
  }
  return points;
}

// Returns the depth with the error of a reconstruction, which is up to 1 %.
double Blurred(RandomSequence* random, double depth_w) {
  return depth_w * (1 + random->Uniform(-0.01, 0.01));
}

Depth DepthOfWall(double depth_w) {
  return [=](RandomSequence* random, double, double) { return Blurred(random, depth_w); };
}
Depth DepthOfCard(double card_w, double wall_w, double half = 0.5) {
  return [=](RandomSequence* random, double x, double y) {
    return Blurred(random, std::abs(x) < half && std::abs(y) < half ? card_w : wall_w);
  };
}
Depth WithOutliers(Depth depth, double share) {
  return [=](RandomSequence* random, double x, double y) {
    if (random->Uniform(0, 1) < share) return std::exp(random->Uniform(-2, 4));
    return depth(random, x, y);
  };
}
Depth AnywhereBetween(double near_w, double far_w) {
  return [=](RandomSequence* random, double, double) {
    return 1 / random->Uniform(1 / far_w, 1 / near_w);
  };
}
Depth Behind(Depth depth) {
  return [=](RandomSequence* random, double x, double y) { return -depth(random, x, y); };
}

struct PointCase {
  std::string name;
  std::vector<Vec3> points;
  double depth_w = 0;      // 0: no depth can be found
  bool may_doubt = false;  // "not sure" is also right
};

std::vector<PointCase> PointCases() {
  return {
      {"wall", Draw(600, DepthOfWall(5)), 5},
      {"wall, few points", Draw(40, DepthOfWall(5)), 5},
      {"wall, many points", Draw(2048, DepthOfWall(0.02)), 0.02},
      {"wall, far", Draw(300, DepthOfWall(4000)), 4000},
      {"wall, a third outliers", Draw(300, WithOutliers(DepthOfWall(2), 0.33)), 2},
      {"wall, two thirds outliers", Draw(300, WithOutliers(DepthOfWall(2), 0.67)), 2, true},
      {"card before a wall", Draw(600, DepthOfCard(2, 6)), 2, true},
      {"card before a near wall", Draw(600, DepthOfCard(2, 2.6, 0.7)), 2},
      {"small card before a wall", Draw(600, DepthOfCard(2, 6, 0.3)), 6, true},
      {"card with outliers", Draw(400, WithOutliers(DepthOfCard(3, 9, 0.7), 0.2)), 3},
      {"large card", Draw(600, DepthOfCard(1, 8, 0.8)), 1},
      {"card, few points", Draw(150, DepthOfCard(2, 6, 0.7)), 2},
      {"wall, points behind the camera",
       [] {
         std::vector<Vec3> points = Draw(200, DepthOfWall(4));
         for (const Vec3& point : Draw(400, Behind(DepthOfWall(3)))) points.push_back(point);
         return points;
       }(),
       4},
      {"hopeless: no points", {}},
      {"hopeless: too few points", Draw(15, DepthOfWall(5))},
      {"hopeless: all behind the camera", Draw(300, Behind(DepthOfWall(5)))},
      {"hopeless: anywhere", Draw(600, AnywhereBetween(1, 20))},
      {"hopeless: anywhere, few", Draw(60, AnywhereBetween(1, 20))},
      {"hopeless: outliers alone", Draw(600, WithOutliers(DepthOfWall(5), 1))},
      {"hopeless: two walls in stripes",
       Draw(600, [](RandomSequence* random, double x,
                    double) { return Blurred(random, std::fmod(x + 1, 0.2) < 0.1 ? 2 : 5); })},
  };
}

TEST(FindPointSubject, IsRightOrNotSureOnTwentyCaptures) {
  ASSERT_EQ(PointCases().size(), 20u);
  for (const PointCase& one : PointCases()) {
    SCOPED_TRACE(one.name);
    const Subject subject = FindPointSubject(Camera(), one.points);
    if (one.depth_w == 0) {
      EXPECT_FALSE(subject.is_sure);
      continue;
    }
    EXPECT_TRUE(subject.is_sure || one.may_doubt);
    if (subject.is_sure) {
      EXPECT_NEAR(subject.depths[0].distance_w, one.depth_w, 0.02 * one.depth_w);
    }
  }
}

TEST(FindPointSubject, OffersTheWallBehindTheCard) {
  const Subject subject = FindPointSubject(Camera(), Draw(600, DepthOfCard(2, 6, 0.7)));
  ASSERT_GE(subject.depths.size(), 2u);
  EXPECT_NEAR(subject.depths[1].distance_w, 6, 0.1);
  EXPECT_NEAR(subject.near_w, 2, 0.05);
  EXPECT_NEAR(subject.far_w, 6, 0.1);
}

TEST(FindPointSubject, PointsOutsideTheImageDoNotCount) {
  std::vector<Vec3> points;
  const PinholeCamera camera = Camera();
  for (int i = 0; i < 100; ++i)
    points.push_back(camera.cam_from_world.Inverse() * Vec3(5 + 0.01 * i, 0, 3));
  EXPECT_EQ(FindPointSubject(camera, points).place_count, 0u);
}

TEST(PointsContradict, OnlyWherePointsAreManyAndNoneIsNear) {
  const std::vector<Vec3> wall = Draw(200, DepthOfWall(5)), few = Draw(20, DepthOfWall(5));
  EXPECT_FALSE(PointsContradict(Camera(), wall, 5.2));
  EXPECT_TRUE(PointsContradict(Camera(), wall, 2));
  EXPECT_TRUE(PointsContradict(Camera(), wall, 8));
  EXPECT_FALSE(PointsContradict(Camera(), few, 2));
  EXPECT_FALSE(PointsContradict(Camera(), {}, 2));
  EXPECT_FALSE(PointsContradict(Camera(), Draw(400, Behind(DepthOfWall(5))), 2));
  // Few of the points belong to the subject, most belong to the wall behind it.
  EXPECT_FALSE(PointsContradict(Camera(), Draw(2000, DepthOfCard(2, 6, 0.2)), 2));
  EXPECT_TRUE(PointsContradict(Camera(), Draw(2000, DepthOfCard(2, 6, 0.2)), 3.5));
}

}  // namespace
}  // namespace lf
