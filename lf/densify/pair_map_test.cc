// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/pair_map.h"

#include <gtest/gtest.h>

#include "lf/core/random.h"

namespace lf {
namespace {

PinholeCamera RandomCamera(RandomSequence* random) {
  PinholeCamera camera;
  const auto any = [&](double most) { return random->Uniform(-most, most); };
  camera.intrinsics = {random->Uniform(300, 500),
                       random->Uniform(300, 500),
                       320 + any(30),
                       240 + any(30),
                       any(2),
                       640,
                       480,
                       {},
                       {}};
  camera.cam_from_world.rotation =
      (Eigen::AngleAxisd(any(0.2), Vec3::UnitX()) * Eigen::AngleAxisd(any(0.2), Vec3::UnitY()) *
       Eigen::AngleAxisd(any(0.2), Vec3::UnitZ()))
          .toRotationMatrix();
  camera.cam_from_world.translation = Vec3(any(0.3), any(0.3), any(0.3));
  return camera;
}

TEST(PairMap, FindsThePlaceAndTheDepthThatProjectionFinds) {
  RandomSequence random(1);
  for (int i = 0; i < 200; ++i) {
    const PinholeCamera first = RandomCamera(&random), second = RandomCamera(&random);
    const double x = random.Uniform(0, 640), y = random.Uniform(0, 480);
    const double depth = random.Uniform(1, 10);
    const Vec3 point = RayOfPixel(first, x, y).At(depth);
    const PairMap::Place place =
        MapBetween(first, second)
            .At(static_cast<float>(x), static_cast<float>(y), static_cast<float>(1 / depth));
    const Vec2 expected = *Project(second, point);
    EXPECT_NEAR(place.u_px, expected.x(), 0.01);
    EXPECT_NEAR(place.v_px, expected.y(), 0.01);
    EXPECT_NEAR(1 / depth / static_cast<double>(place.w), 1 / (second.cam_from_world * point).z(),
                1e-5);
  }
}

TEST(PairMap, APointBehindTheSecondCameraHasNoPositiveW) {
  PinholeCamera first, second;
  first.intrinsics = second.intrinsics = {100, 100, 50, 50, 0, 100, 100, {}, {}};
  second.cam_from_world.translation = Vec3(0, 0, -2);
  EXPECT_LE(MapBetween(first, second).At(50, 50, 1).w, 0);
  EXPECT_GT(MapBetween(first, second).At(50, 50, 0.25f).w, 0);
}

TEST(PairMap, TheShiftIsFocalLengthTimesTheDistanceAcrossTheAxis) {
  PinholeCamera first, second;
  first.intrinsics = second.intrinsics = {100, 100, 50, 50, 0, 100, 100, {}, {}};
  second.cam_from_world.translation = -Vec3(3, 4, 7);
  EXPECT_NEAR(ShiftPerInverseDepth(first, second), 500, 1e-9);
}

}  // namespace
}  // namespace lf
