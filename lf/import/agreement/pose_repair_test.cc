// SPDX-License-Identifier: Apache-2.0
#include "lf/import/agreement/pose_repair.h"

#include <gtest/gtest.h>

#include <vector>

#include "lf/camera/pinhole.h"

namespace lf {
namespace {

PinholeCamera SomeCamera() {
  const Intrinsics k{.fx_px = 500,
                     .fy_px = 510,
                     .cx_px = 310,
                     .cy_px = 235,
                     .skew_px = 0,
                     .width_px = 640,
                     .height_px = 480};
  return {k, *LookAlong({1, 2, 3}, {0.3, -0.2, 1}, {0.1, 1, 0})};
}

double PoseDifference(const RigidTransform& a, const RigidTransform& b) {
  return (a.rotation - b.rotation).norm() + (a.translation - b.translation).norm();
}

TEST(PoseRepair, TheWordsOfARepairGiveTheRepairAgain) {
  for (const Repair& repair : UsualRepairs(false)) {
    const Result<Repair> parsed = ParseRepair(NameOf(repair));
    ASSERT_TRUE(parsed) << NameOf(repair) << ": " << parsed.error().message;
    EXPECT_EQ(*parsed, repair) << NameOf(repair);
  }
  const Repair focal{.focal_factors = {17.5, 20.25}};
  EXPECT_EQ(*ParseRepair(NameOf(focal)), focal);
  EXPECT_TRUE(ParseRepair("")->is_none());
}

TEST(PoseRepair, UnknownWordsAndLeftHandedCamerasAreRefused) {
  for (const char* text : {"invers", "axes:xy", "axes:xxz", "axes:-xyz", "focal:0", "focal:1xx2"})
    EXPECT_FALSE(ParseRepair(text)) << text;
}

TEST(PoseRepair, MistakesThatAreTheirOwnOppositeAreUndone) {
  const PinholeCamera right = SomeCamera();
  for (const char* text : {"inverse", "transpose", "transpose-opengl", "transpose-rotation",
                           "axes:x-y-z", "positions:xzy", "mirror-x", "mirror-y"}) {
    const Repair repair = *ParseRepair(text);
    const PinholeCamera wrong = RepairedCamera(repair, right, false);
    EXPECT_GT(PoseDifference(wrong.cam_from_world, right.cam_from_world), 0.1) << text;
    const PinholeCamera again = RepairedCamera(repair, wrong, false);
    EXPECT_LT(PoseDifference(again.cam_from_world, right.cam_from_world), 1e-9) << text;
    EXPECT_DOUBLE_EQ(again.intrinsics.cx_px, right.intrinsics.cx_px) << text;
  }
}

TEST(PoseRepair, AMirroredImageOfAMirroredWorldShowsPointsWhereTheyWere) {
  const PinholeCamera right = SomeCamera();
  const PinholeCamera mirrored = RepairedCamera({.mirror_x = true}, right, false);
  const Vec3 point(2, 1, 9);
  const std::optional<Vec2> at = Project(right, point);
  const std::optional<Vec2> mirrored_at = Project(mirrored, {-point.x(), point.y(), point.z()});
  ASSERT_TRUE(at && mirrored_at);
  EXPECT_NEAR(mirrored_at->x(), right.intrinsics.width_px - at->x(), 1e-9);
  EXPECT_NEAR(mirrored_at->y(), at->y(), 1e-9);
}

TEST(PoseRepair, NormalisedPrincipalPointsComeAlongWithTheFocalLength) {
  PinholeCamera camera = SomeCamera();
  Intrinsics& k = camera.intrinsics;
  const Intrinsics right = k;
  k.fx_px /= 640, k.cx_px /= 640, k.fy_px /= 480, k.cy_px /= 480;
  const Intrinsics repaired =
      RepairedCamera({.focal_factors = {640, 480}}, camera, false).intrinsics;
  EXPECT_NEAR(repaired.fx_px, right.fx_px, 1e-9);
  EXPECT_NEAR(repaired.fy_px, right.fy_px, 1e-9);
  EXPECT_NEAR(repaired.cx_px, right.cx_px, 1e-9);
  EXPECT_NEAR(repaired.cy_px, right.cy_px, 1e-9);
}

TEST(PoseRepair, PrincipalPointsOfLargerImagesComeAlongWithTheFocalLength) {
  PinholeCamera camera = SomeCamera();  // images were reduced to half, the calibration was not
  Intrinsics& k = camera.intrinsics;
  const Intrinsics right = k;
  k.fx_px *= 2, k.cx_px *= 2, k.fy_px *= 2, k.cy_px *= 2;
  const Repair half{.focal_factors = {0.5, 0.5}};
  EXPECT_NEAR(RepairedCamera(half, camera, false).intrinsics.cx_px, right.cx_px, 1e-9);
  EXPECT_NEAR(RepairedCamera(half, camera, false).intrinsics.cy_px, right.cy_px, 1e-9);
  EXPECT_EQ(RepairedCamera(half, camera, true).intrinsics.cx_px, k.cx_px) << "of a slab";
}

TEST(PoseRepair, NamesAreSortedByTheirNumbers) {
  const std::vector<std::string> names = {"a10.png", "a1.png", "a2.png", "a02b.png"};
  EXPECT_EQ(NaturalOrder(names), (std::vector<uint32_t>{1, 2, 3, 0}));
  // Each image gets the camera recorded for the next name; the last gets none.
  EXPECT_EQ(CamerasOfImages(NameOrder::kNext, names),
            (std::vector<uint32_t>{LfCamera::kNone, 2, 3, 0}));
  EXPECT_EQ(CamerasOfImages(NameOrder::kReversed, names), (std::vector<uint32_t>{1, 0, 3, 2}));
}

TEST(PoseRepair, SortingAsTextIsUndone) {
  // The second pose by number went to the second name as text, a10.
  const std::vector<std::string> names = {"a1", "a2", "a10"};
  EXPECT_EQ(CamerasOfImages(NameOrder::kFromText, names), (std::vector<uint32_t>{0, 2, 1}));
}

TEST(PoseRepair, ImagesWithoutAPoseAreRemoved) {
  LightField field;
  field.intrinsics = {SomeCamera().intrinsics};
  field.image_names = {"0.png", "1.png", "2.png"};
  field.cameras.resize(3);
  for (size_t i = 0; i < 3; ++i)
    field.cameras[i].cam_from_world.translation = Vec3(static_cast<double>(i), 0, 0);
  EXPECT_EQ(ApplyRepair({.names = NameOrder::kNext}, &field), 1u);
  ASSERT_EQ(field.size(), 2u);
  EXPECT_EQ(field.image_names, (std::vector<std::string>{"0.png", "1.png"}));
  EXPECT_EQ(field.cameras[0].cam_from_world.translation.x(), 1);
  EXPECT_EQ(field.cameras[1].cam_from_world.translation.x(), 2);
}

}  // namespace
}  // namespace lf
