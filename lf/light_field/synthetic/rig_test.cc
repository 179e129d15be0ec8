// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/rig.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/pinhole.h"

namespace lf {
namespace {

RigOptions Rig(RigShape shape, uint32_t count) {
  RigOptions options;
  options.shape = shape;
  options.count = count;
  options.spacing_w = 0.01;
  options.distance_w = 2;
  options.target_world = {0.3, -0.1, 0.5};
  options.view_world = {0.2, 0.1, 1};
  return options;
}

PinholeCamera At(const RigidTransform& pose) { return {{}, pose}; }

TEST(Rig, TheGridHasItsSpacingAndLooksOneWay) {
  const RigOptions options = Rig(RigShape::kPlanar, 20);
  const auto poses = *MakeRig(options);
  ASSERT_EQ(poses.size(), 20U);  // 4 rows of 5
  Vec3 mean = Vec3::Zero();
  for (size_t i = 0; i < poses.size(); ++i) {
    const PinholeCamera camera = At(poses[i]);
    mean += camera.CentreWorld() / 20;
    EXPECT_NEAR(camera.ForwardWorld().dot(options.view_world.normalized()), 1, 1e-12);
    EXPECT_NEAR(camera.RightWorld().y(), 0, 1e-12);
    if (i % 5 != 4) {
      const Vec3 step = At(poses[i + 1]).CentreWorld() - camera.CentreWorld();
      EXPECT_TRUE(step.isApprox(0.01 * camera.RightWorld(), 1e-9));
    }
    if (i < 15) {
      const Vec3 step = At(poses[i + 5]).CentreWorld() - camera.CentreWorld();
      EXPECT_TRUE(step.isApprox(-0.01 * camera.UpWorld(), 1e-9));  // rows are counted from the top
    }
  }
  EXPECT_NEAR((options.target_world - mean).norm(), 2, 1e-12);
  EXPECT_NEAR((options.target_world - mean).cross(options.view_world).norm(), 0, 1e-12);
}

TEST(Rig, TheBandLiesOnItsCircleAndLooksAtTheTarget) {
  const RigOptions options = Rig(RigShape::kBand, 300);
  const auto poses = *MakeRig(options);
  ASSERT_EQ(poses.size(), 300U);
  for (size_t i = 0; i < poses.size(); ++i) {
    const PinholeCamera camera = At(poses[i]);
    const Vec3 to_target = options.target_world - camera.CentreWorld();
    EXPECT_NEAR(to_target.norm(), 2, 2e-3);  // the upper and lower rows are a little farther away
    EXPECT_NEAR(to_target.normalized().dot(camera.ForwardWorld()), 1, 1e-12);
    EXPECT_NEAR(camera.RightWorld().y(), 0, 1e-12);
    if (i % 100 != 99) {
      EXPECT_NEAR((At(poses[i + 1]).CentreWorld() - camera.CentreWorld()).norm(), 0.01, 1e-4);
    }
  }
  // Columns go to the right as seen by the middle camera.
  const Vec3 across = At(poses[199]).CentreWorld() - At(poses[100]).CentreWorld();
  EXPECT_GT(across.dot(At(poses[150]).RightWorld()), 0.9);
}

TEST(Rig, TheDomeIsEvenAndLooksAtItsCentre) {
  const RigOptions options = Rig(RigShape::kHemisphere, 500);
  const auto poses = *MakeRig(options);
  ASSERT_EQ(poses.size(), 500U);
  Vec3 mean = Vec3::Zero();
  for (const RigidTransform& pose : poses) {
    const Vec3 out = At(pose).CentreWorld() - options.target_world;
    EXPECT_NEAR(out.norm(), 2, 1e-9);
    EXPECT_LT(out.y(), 0);  // above: y points down
    EXPECT_NEAR(-out.normalized().dot(At(pose).ForwardWorld()), 1, 1e-12);
    mean += out / 500;
  }
  EXPECT_TRUE(mean.isApprox(Vec3(0, -1, 0), 1e-2));  // the mean of a half sphere is at half its
                                                     // radius
  // Nearest neighbours are about a pitch apart, and none are much closer.
  for (size_t i = 0; i < poses.size(); ++i) {
    double nearest = 10;
    for (size_t j = 0; j < poses.size(); ++j)
      if (i != j)
        nearest =
            std::min(nearest, (At(poses[i]).CentreWorld() - At(poses[j]).CentreWorld()).norm());
    EXPECT_GT(nearest, 0.5 * RigPitch(options));
    EXPECT_LT(nearest, 1.2 * RigPitch(options));
  }
}

TEST(Rig, CountsComeOutNearWhatWasAskedFor) {
  for (const uint32_t count : {1U, 2U, 3U, 7U, 50U, 289U, 1000U})
    for (const RigShape shape : {RigShape::kPlanar, RigShape::kBand, RigShape::kHemisphere}) {
      const auto poses = *MakeRig(Rig(shape, count));
      EXPECT_NEAR(static_cast<double>(poses.size()), count, std::ceil(std::sqrt(count) / 2.0));
    }
}

TEST(Rig, JitterIsBoundedAndTheSameForTheSameSeed) {
  for (const RigShape shape : {RigShape::kPlanar, RigShape::kBand, RigShape::kHemisphere}) {
    RigOptions options = Rig(shape, 100);
    const auto still = *MakeRig(options);
    options.jitter = 0.3;
    const auto shaken = *MakeRig(options);
    const auto again = *MakeRig(options);
    options.seed = 1;
    const auto other = *MakeRig(options);
    double widest = 0;
    for (size_t i = 0; i < still.size(); ++i) {
      const Vec3 moved =
          still[i].rotation * (At(shaken[i]).CentreWorld() - At(still[i]).CentreWorld());
      widest = std::max(widest, moved.cwiseAbs().maxCoeff());
      const Eigen::AngleAxisd turn(shaken[i].rotation * still[i].rotation.transpose());
      EXPECT_LE(turn.angle(), RadiansFromDegrees(0.3 * std::sqrt(3.0) * 1.01));
      EXPECT_TRUE(shaken[i].rotation.isUnitary(1e-12));
      EXPECT_EQ(shaken[i].rotation, again[i].rotation);
      EXPECT_EQ(shaken[i].translation, again[i].translation);
      EXPECT_NE(shaken[i].translation, other[i].translation);
    }
    EXPECT_LE(widest, 0.3 * RigPitch(options) * (1 + 1e-9));
    EXPECT_GT(widest, 0.2 * RigPitch(options));
  }
}

TEST(Rig, ImpossibleRigsAreRefused) {
  const auto message = [](const RigOptions& options) { return MakeRig(options).error().message; };
  RigOptions options = Rig(RigShape::kBand, 5000);
  EXPECT_NE(message(options).find("longer than its circle"), std::string::npos);
  options = Rig(RigShape::kPlanar, 0);
  EXPECT_NE(message(options).find("0 cameras"), std::string::npos);
  options = Rig(RigShape::kPlanar, 9);
  options.spacing_w = -1;
  EXPECT_NE(message(options).find("spacing -1"), std::string::npos);
  options = Rig(RigShape::kPlanar, 9);
  options.distance_w = std::nan("");
  EXPECT_NE(message(options).find("distance nan"), std::string::npos);
  options = Rig(RigShape::kPlanar, 9);
  options.jitter = 1.5;
  EXPECT_NE(message(options).find("jitter 1.5"), std::string::npos);
  options = Rig(RigShape::kPlanar, 9);
  options.view_world = Vec3::UnitY();
  EXPECT_NE(message(options).find("not parallel to the up direction"), std::string::npos);
}

}  // namespace
}  // namespace lf
