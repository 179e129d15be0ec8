// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/orientation.h"

#include <gtest/gtest.h>

#include "lf/camera/path/test_near.h"

namespace lf {
namespace {

constexpr double kQuarter = kPi / 2;

Vec3 Turned(double yaw, double pitch, double roll, const Vec3& axis_camera) {
  return WorldFromCam(yaw, pitch, roll) * axis_camera;
}

const Vec3 kRight = Vec3::UnitX();
const Vec3 kDown = Vec3::UnitY();
const Vec3 kForward = Vec3::UnitZ();

TEST(Orientation, WithoutAnglesTheCameraLooksAlongZWithYDown) {
  ExpectNear(Turned(0, 0, 0, kForward), {0, 0, 1});
  ExpectNear(Turned(0, 0, 0, kDown), {0, 1, 0});
}

TEST(Orientation, YawTurnsToTheRight) { ExpectNear(Turned(kQuarter, 0, 0, kForward), kRight); }

TEST(Orientation, PitchTurnsUp) { ExpectNear(Turned(0, kQuarter, 0, kForward), -kDown); }

TEST(Orientation, RollTurnsClockwise) { ExpectNear(Turned(0, 0, kQuarter, kRight), kDown); }

TEST(Orientation, YawComesLastSoThatPitchStaysAPitch) {
  // The camera turns right and then up by 30 degrees; the horizon must stay level.
  const double pitch = RadiansFromDegrees(30);
  ExpectNear(Turned(kQuarter, pitch, 0, kForward), {std::cos(pitch), -std::sin(pitch), 0});
  EXPECT_NEAR(Turned(kQuarter, pitch, 0, kRight).y(), 0, 1e-12);
}

TEST(Orientation, ThePoseHasTheCentreItWasGiven) {
  const RigidTransform pose = CamFromWorld(WorldFromCam(0.3, 0.2, 0.1), {1, 2, 3});
  ExpectNear(pose * Vec3(1, 2, 3), {0, 0, 0});
}

TEST(Orientation, AFurtherRollIsTheRollOfTheAngles) {
  const Vec3 centre(1, 2, 3);
  const RigidTransform level = CamFromWorld(WorldFromCam(0.4, 0.3, 0), centre);
  const RigidTransform rolled = CamFromWorld(WorldFromCam(0.4, 0.3, 0.2), centre);
  EXPECT_TRUE(Rolled(level, 0.2).rotation.isApprox(rolled.rotation, 1e-12));
  ExpectNear(Rolled(level, 0.2).translation, rolled.translation);
}

}  // namespace
}  // namespace lf
