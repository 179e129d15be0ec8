// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/opengl_pose.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "lf/core/random.h"

namespace lf {
namespace {

Mat34 Pose(const Mat3& axes, const Vec3& centre) {
  Mat34 pose;
  pose << axes, centre;
  return pose;
}

Mat3 Rotation(uint64_t seed) {
  Eigen::Quaterniond q(RandomUnit(seed, 0, 0) - 0.5, RandomUnit(seed, 0, 1) - 0.5,
                       RandomUnit(seed, 0, 2) - 0.5, RandomUnit(seed, 0, 3) - 0.5);
  return q.normalized().toRotationMatrix();
}

std::string PoseErrorOf(const Mat34& pose) {
  const auto result = CamFromWorldOfOpenGl(pose);
  return result ? "" : result.error().message;
}

TEST(OpenGlPose, AnUnturnedCameraLooksAlongMinusZWithYUp) {
  const RigidTransform cam_from_world =
      *CamFromWorldOfOpenGl(Pose(Mat3::Identity(), Vec3(10, 20, 30)));
  EXPECT_EQ(cam_from_world * Vec3(10, 20, 29), Vec3(0, 0, 1));   // ahead
  EXPECT_EQ(cam_from_world * Vec3(11, 20, 30), Vec3(1, 0, 0));   // right
  EXPECT_EQ(cam_from_world * Vec3(10, 21, 30), Vec3(0, -1, 0));  // above
}

TEST(OpenGlPose, ColumnsAreTheAxesOfTheCamera) {
  Mat3 axes;  // of a camera that looks along +x of the world, with z of the world up
  axes.col(0) = Vec3(0, -1, 0);
  axes.col(1) = Vec3(0, 0, 1);
  axes.col(2) = Vec3(-1, 0, 0);
  const RigidTransform cam_from_world = *CamFromWorldOfOpenGl(Pose(axes, Vec3(1, 2, 3)));
  EXPECT_EQ(cam_from_world * Vec3(6, 2, 3), Vec3(0, 0, 5));
  EXPECT_EQ(cam_from_world * Vec3(1, 2, 4), Vec3(0, -1, 0));
}

TEST(OpenGlPose, ScaleOfTheAxesDoesNotMatter) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const Mat3 axes = Rotation(seed);
    const Vec3 centre(1, -2, 0.5);
    const RigidTransform expected = *CamFromWorldOfOpenGl(Pose(axes, centre));
    for (const double scale : {1e-5, 0.3, 1.0000001, 500.0}) {
      const RigidTransform scaled = *CamFromWorldOfOpenGl(Pose(scale * axes, centre));
      EXPECT_LT((scaled.rotation - expected.rotation).cwiseAbs().maxCoeff(), 1e-14);
      EXPECT_LT((scaled.translation - expected.translation).norm(), 1e-13);
    }
  }
}

TEST(OpenGlPose, ARotationWrittenWithFewDigitsBecomesARotationAgain) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    Mat3 axes = Rotation(seed);
    for (int i = 0; i < 9; ++i) axes(i) = std::round(axes(i) * 1e4) / 1e4;
    const Mat3 rotation = CamFromWorldOfOpenGl(Pose(axes, Vec3::Zero()))->rotation;
    EXPECT_LT((rotation * rotation.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_GT(rotation.determinant(), 0);
    const Mat3 flip = Vec3(1, -1, -1).asDiagonal();
    EXPECT_LT((rotation - flip * Rotation(seed).transpose()).cwiseAbs().maxCoeff(), 1e-4);
  }
}

TEST(OpenGlPose, RotationsComeBackBitForBit) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    RigidTransform cam_from_world{Rotation(seed), Vec3(0.1, -3, 1e3)};
    const RigidTransform back = *CamFromWorldOfOpenGl(OpenGlOfCamFromWorld(cam_from_world));
    EXPECT_EQ(back.rotation, cam_from_world.rotation);
    EXPECT_LT((back.translation - cam_from_world.translation).norm(), 1e-11);
  }
}

TEST(OpenGlPose, WhatIsNoRotationIsRefusedWithItsReason) {
  const Mat3 identity = Mat3::Identity();
  Mat3 mirrored = identity;
  mirrored(0, 0) = -1;
  EXPECT_NE(PoseErrorOf(Pose(mirrored, Vec3::Zero())).find("mirrored"), std::string::npos);
  Mat3 sheared = identity;
  sheared(0, 1) = 0.01;
  EXPECT_NE(PoseErrorOf(Pose(sheared, Vec3::Zero())).find("sheared"), std::string::npos);
  const Mat3 uneven = Vec3(1, 1, 1.01).asDiagonal();
  EXPECT_NE(PoseErrorOf(Pose(uneven, Vec3::Zero())).find("scaled"), std::string::npos);
  const Mat3 flat = Vec3(1, 1, 0).asDiagonal();
  EXPECT_NE(PoseErrorOf(Pose(flat, Vec3::Zero())).find("determinant"), std::string::npos);
  EXPECT_EQ(PoseErrorOf(Pose(Mat3::Zero(), Vec3::Zero())),
            "has the determinant 0: expected a rotation, times a scale of at least 1e-06");
  EXPECT_EQ(PoseErrorOf(Pose(1e-7 * identity, Vec3::Zero())),
            "has the determinant 1e-21: expected a rotation, times a scale of at least 1e-06");
  EXPECT_EQ(PoseErrorOf(Pose(identity, Vec3(0, -1e13, 0))),
            "holds -1e+13, expected numbers from -1e+12 to 1e+12");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(PoseErrorOf(Pose(identity, Vec3(0, nan, 0))),
            "holds nan, expected numbers from -1e+12 to 1e+12");
}

}  // namespace
}  // namespace lf
