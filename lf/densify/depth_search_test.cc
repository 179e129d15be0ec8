// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_search.h"

#include <gtest/gtest.h>

#include "lf/densify/test_world.h"

namespace lf {
namespace {

constexpr double kShift = 30;  // pixels per unit of inverse depth

TEST(SearchedRange, EndsAtAShiftOfThreeTenthsOfTheLongerSide) {
  const InverseDepths lying = SearchedRange(CameraAt(0, 0, 100, 60), kShift, {}, {});
  EXPECT_NEAR(lying.greatest, 1, 1e-12);
  EXPECT_NEAR(lying.least, -0.1, 1e-12);
  const InverseDepths standing = SearchedRange(CameraAt(0, 0, 60, 100), kShift, {}, {});
  EXPECT_EQ(standing.greatest, lying.greatest);
}

TEST(SearchedRange, IsAroundThePointThatCamerasLookAt) {
  const PinholeCamera camera = CameraAt(0, 0, 100, 60);
  const InverseDepths range = SearchedRange(camera, kShift, Vec3(0.3, 0.1, 0.25), {});
  EXPECT_NEAR(range.greatest, 1 + 4, 1e-12);
  EXPECT_LT(range.least, 0);
  EXPECT_NEAR(SearchedRange(camera, kShift, Vec3(0, 0, -2), {}).greatest, 1, 1e-12);
}

TEST(SearchedRange, StaysNearTheStatedRange) {
  const PinholeCamera camera = CameraAt(0, 0, 100, 60);
  const InverseDepths range = SearchedRange(camera, kShift, {}, DepthRange{4, 20});
  EXPECT_NEAR(range.least, 0.5 / 20, 1e-12);
  EXPECT_NEAR(range.greatest, 1.5 / 4, 1e-12);
  const InverseDepths near_plane = SearchedRange(camera, kShift, {}, DepthRange{0.001, 1000});
  EXPECT_NEAR(near_plane.greatest, 1, 1e-12);
}

TEST(SearchedRange, AStatedRangeThatNoTwoCamerasSeeHasNoEffect) {
  const PinholeCamera camera = CameraAt(0, 0, 100, 60);
  const InverseDepths range = SearchedRange(camera, kShift, {}, DepthRange{0.01, 0.02});
  EXPECT_NEAR(range.least, -0.1, 1e-12);
  EXPECT_NEAR(range.greatest, 1, 1e-12);
}

}  // namespace
}  // namespace lf
