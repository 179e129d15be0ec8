// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/chan_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lf/camera/path/path_yaml.h"
#include "lf/import/paths/euler_angles.h"
#include "lf/import/paths/test_paths.h"

namespace lf {
namespace {

constexpr RotationOrder kOrders[] = {RotationOrder::kXyz, RotationOrder::kXzy, RotationOrder::kYxz,
                                     RotationOrder::kYzx, RotationOrder::kZxy, RotationOrder::kZyx};

Result<ForeignPath> ParsedChan(std::string_view text, const PathOptions& options = {}) {
  return ParseChan(ByteStream(text, "c.chan"), options);
}

void ExpectChanError(std::string_view text, const std::vector<std::string>& parts) {
  const Result<ForeignPath> path = ParsedChan(text);
  ASSERT_FALSE(path) << text;
  EXPECT_EQ(path.error().message.find("c.chan:"), 0u) << path.error().message;
  for (const std::string& part : parts)
    EXPECT_NE(path.error().message.find(part), std::string::npos)
        << part << "\nnot in: " << path.error().message;
}

TEST(ChanPath, RotationsAreAppliedInTheirOrder) {
  // First a quarter turn about z, then one about x: the axis x of the camera goes to y, then to z.
  const Result<ForeignPath> path = ParsedChan("# a comment\n\n1 1 2 3 90 0 90 40\n");
  ASSERT_TRUE(path) << path.error().message;
  const PinholeCamera& camera = path->cameras[0].pinhole;
  EXPECT_LT((camera.RightWorld() - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((camera.CentreWorld() - Vec3(1, 2, 3)).norm(), 1e-12);
  // First about x, then about z: the axis x stays, then goes to y.
  const Result<ForeignPath> other =
      ParsedChan("1 1 2 3 90 0 90 40\n", {.rotation_order = RotationOrder::kXyz});
  ASSERT_TRUE(other);
  EXPECT_LT((other->cameras[0].pinhole.RightWorld() - Vec3(0, 1, 0)).norm(), 1e-12);
}

TEST(ChanPath, AnglesAndRotationsAreInverseInEveryOrder) {
  for (const RotationOrder order : kOrders)
    for (const Vec3& angles : {Vec3(0.3, -0.7, 1.1), Vec3(-2, 0.4, 3), Vec3(1.2, 2.9, -3.1)}) {
      const Mat3 rotation = RotationOfAngles(angles, order);
      const Vec3 found = AnglesOfRotation(rotation, order, Vec3::Zero());
      EXPECT_LT((RotationOfAngles(found, order) - rotation).norm(), 1e-12);
      // The triple of angles that is nearest to the frame before is taken.
      const Vec3 turned = angles + 2 * kPi * Vec3(1, -2, 3);
      EXPECT_LT((AnglesOfRotation(rotation, order, turned + Vec3(0.1, 0.1, -0.1)) - turned).norm(),
                1e-9);
    }
}

TEST(ChanPath, AnglesSurviveAGimbalLock) {
  for (const RotationOrder order : kOrders) {
    Vec3 angles(0.4, 0.5, 0.6);
    angles[AxesOf(order)[1]] = kPi / 2;
    const Mat3 rotation = RotationOfAngles(angles, order);
    const Vec3 found = AnglesOfRotation(rotation, order, Vec3(0.1, 0.1, 0.1));
    EXPECT_LT((RotationOfAngles(found, order) - rotation).norm(), 1e-9);
    // The angle that is applied first stays as it was in the frame before.
    EXPECT_NEAR(found[AxesOf(order)[0]], 0.1, 1e-9);
  }
}

TEST(ChanPath, WithoutAFieldOfViewALensIsUsed) {
  const PathOptions plate = {.resolution_px = std::array<int, 2>{720, 100}, .fps = 24};
  const Result<ForeignPath> path = ParsedChan("1 0 0 0 0 0 0", plate);
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->cameras[0].pinhole.intrinsics.fx_px, 1000, 1e-9);  // 720 * 50 / 36
  ASSERT_EQ(path->lacks.size(), 1u);
  EXPECT_NE(path->lacks[0].find("{focal_length_mm}"), std::string::npos);
  PathOptions lens = plate;
  lens.focal_length_mm = 24;
  lens.sensor_width_mm = 12;
  EXPECT_NEAR(ParsedChan("1 0 0 0 0 0 0", lens)->cameras[0].pinhole.intrinsics.fx_px, 1440, 1e-9);
  EXPECT_EQ(ParsedChan("1 0 0 0 0 0 0 40", lens).error().kind, ErrorKind::kUsage);
}

TEST(ChanPath, AFieldOfViewMayBeInRadiansIfThatIsSaid) {
  const PathOptions options = {.resolution_px = std::array<int, 2>{200, 100},
                               .fov_unit = FovUnit::kRadians};
  const Result<ForeignPath> path = ParsedChan("1 0 0 0 0 0 0 0.87", options);
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->cameras[0].pinhole.intrinsics.fy_px, 50 / std::tan(0.435), 1e-9);
  EXPECT_EQ(ParsedChan("1 0 0 0 0 0 0 0.87\n2 0 0 0 0 0 0 1.2")->largest_fov, 1.2);
  EXPECT_FALSE(ParsedChan("1 0 0 0 0 0 0")->largest_fov);
  EXPECT_NE(ParsedChan("1 0 0 0 0 0 0 40", options).error().message.find("in radians"),
            std::string::npos);
}

TEST(ChanPath, FramesKeepTheirNumbers) {
  EXPECT_EQ(ParsedChan("1001 0 0 0 0 0 0 40\n1002 0 0 0 0 0 0 40\n")->first_frame, 1001u);
  EXPECT_EQ(ParsedChan("0 0 0 0 0 0 0 40\n")->first_frame, 0u);
  // Files of frames have no negative numbers, and eight digits at most.
  for (const char* text : {"-2 0 0 0 0 0 0 40\n-1 0 0 0 0 0 0 40\n",
                           "99999999 0 0 0 0 0 0 40\n100000000 "
                           "0 0 0 0 0 0 40\n"}) {
    const Result<ForeignPath> path = ParsedChan(text);
    ASSERT_TRUE(path) << path.error().message;
    EXPECT_EQ(path->first_frame, 1u);
    EXPECT_NE(path->lacks.back().find("no frame numbers from 0"), std::string::npos);
  }
}

TEST(ChanPath, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(ParsedChan("\xEF\xBB\xBF"
                       "1 0 0 0 0 0 0 40\n2 0 0 0 0 0 0 40\n")
                ->cameras.size(),
            2u);
}

TEST(ChanPath, ErrorsNameTheLineTheValueAndTheRemedy) {
  ExpectChanError("1 0 0 0 0 0 0 40\n3 0 0 0 0 0 0 40", {":2: ", "is 3, after 1", "expected 2"});
  ExpectChanError("1 0 0 0 0 0\n", {":1: rz is missing", "frame tx ty tz"});
  ExpectChanError("1 0 0 zero 0 0 0", {":1: tz is \"zero\""});
  ExpectChanError("1 0 0 0 0 0 0 180", {"is 180: expected", "in degrees", "below 180"});
  ExpectChanError("1 0 0 0 0 0 0 40 1", {"more than 8 columns"});
  ExpectChanError("1.5 0 0 0 0 0 0 40", {"frame number is 1.5"});
  ExpectChanError("1 1e13 0 0 0 0 0 40", {"tx is 1e+13"});
  ExpectChanError("# nothing\n", {" has no frames"});
}

TEST(ChanPath, WhatIsWrittenIsRead) {
  const Result<CameraPath> path = ParsePathYaml(
      "format: lfpath 1\nfps: 24\nframes: 50\nresolution: [90, 60]\n"
      "camera: {field_of_view_deg: 40, focal_length_mm: 50, position: [1, 2, 3], speed: [3, 2, 1], "
      "look_at: [0, 0.1, 0], roll_deg: 0, roll_speed_deg: 400}\n"
      "lens: {aperture_diameter: 0, focus_distance: 1}\n",
      "p.yaml", std::nullopt);
  ASSERT_TRUE(path);
  for (const RotationOrder order : kOrders) {
    const std::string text = ChanText(*path, order);
    const Result<ForeignPath> read =
        ParsedChan(text, {.resolution_px = std::array<int, 2>{90, 60}, .rotation_order = order});
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->cameras.size(), 50u);
    for (size_t i = 0; i < 50; ++i) {
      const PinholeCamera &a = path->cameras[i].pinhole, &b = read->cameras[i].pinhole;
      EXPECT_LT((a.cam_from_world.rotation - b.cam_from_world.rotation).norm(), 1e-12);
      EXPECT_LT((a.CentreWorld() - b.CentreWorld()).norm(), 1e-12);
      EXPECT_NEAR(a.intrinsics.fx_px, b.intrinsics.fx_px, 1e-9);
    }
  }
}

}  // namespace
}  // namespace lf
