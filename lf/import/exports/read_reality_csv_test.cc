// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_reality_csv.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "lf/import/exports/reality_lens.h"

namespace lf {
namespace {

const std::string kCsvHeader = "#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n";

LightField OpenedCsv(const std::string& text) {
  Result<ExportedCameras> cameras = ParseRealityCsv(text, "f/cameras.csv");
  EXPECT_TRUE(cameras) << cameras.error().message << "\n" << text;
  if (!cameras) return {};
  ExportOptions options;
  options.image_size = [](const std::filesystem::path&) { return Result(std::array{640, 480}); };
  Result<LightField> light_field = FinishExport(*std::move(cameras), "f/cameras.csv", options);
  EXPECT_TRUE(light_field) << light_field.error().message;
  return light_field ? *std::move(light_field) : LightField();
}

void ExpectCsvError(const std::string& text, const std::vector<std::string>& parts) {
  const Result<ExportedCameras> cameras = ParseRealityCsv(text, "f/cameras.csv");
  ASSERT_FALSE(cameras) << text;
  const std::string& message = cameras.error().message;
  EXPECT_TRUE(message.starts_with("f/cameras.csv: ")) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

// The matrix that the makers of RealityCapture publish, with x = roll, y = pitch and z = yaw.
Mat3 RotationByMakers(double yaw_deg, double pitch_deg, double roll_deg) {
  const double x = RadiansFromDegrees(roll_deg), y = RadiansFromDegrees(pitch_deg),
               z = RadiansFromDegrees(yaw_deg);
  const double cx = std::cos(x), cy = std::cos(y), cz = std::cos(z);
  const double sx = std::sin(x), sy = std::sin(y), sz = std::sin(z);
  Mat3 rotation;
  rotation << cx * cz + sx * sy * sz, -cx * sz + cz * sx * sy, -cy * sx,  //
      -cy * sz, -cy * cz, -sy,                                            //
      cx * sy * sz - cz * sx, cx * cz * sy + sx * sz, -cx * cy;
  return rotation;
}

TEST(RealityRotation, IsTheMatrixThatTheMakersPublish) {
  for (const double yaw : {0.0, 30.0, -120.0})
    for (const double pitch : {0.0, 20.0, 90.0, -75.0})
      for (const double roll : {0.0, 10.0, 170.0})
        EXPECT_LE((RealityRotation(yaw, pitch, roll) - RotationByMakers(yaw, pitch, roll))
                      .cwiseAbs()
                      .maxCoeff(),
                  1e-14)
            << yaw << " " << pitch << " " << roll;
}

TEST(RealityRotation, WithoutAnglesTheCameraLooksDownWithNorthAbove) {
  const Mat3 rotation = RealityRotation(0, 0, 0);
  EXPECT_EQ(rotation * Vec3(1, 0, 0), Vec3(1, 0, 0));   // east is right
  EXPECT_EQ(rotation * Vec3(0, 1, 0), Vec3(0, -1, 0));  // north is up in the image
  EXPECT_EQ(rotation * Vec3(0, 0, -1), Vec3(0, 0, 1));  // down is ahead
}

TEST(RealityRotation, EachAngleTurnsItsOwnWay) {
  const auto ahead = [](double yaw, double pitch, double roll) {
    return Vec3(RealityRotation(yaw, pitch, roll).transpose() * Vec3(0, 0, 1));
  };
  const auto right = [](double yaw, double pitch, double roll) {
    return Vec3(RealityRotation(yaw, pitch, roll).transpose() * Vec3(1, 0, 0));
  };
  EXPECT_LE((ahead(0, 90, 0) - Vec3(0, 1, 0)).norm(), 1e-15);   // level: to the north
  EXPECT_LE((ahead(90, 90, 0) - Vec3(1, 0, 0)).norm(), 1e-15);  // yaw is clockwise: to the east
  EXPECT_LE((right(90, 0, 0) - Vec3(0, -1, 0)).norm(), 1e-15);
  // Roll turns the right wing down.
  EXPECT_LE((right(0, 0, 90) - Vec3(0, 0, -1)).norm(), 1e-15);
  EXPECT_LE((ahead(0, 0, 90) - Vec3(-1, 0, 0)).norm(), 1e-15);
}

// A user published what RealityCapture wrote into both files for one camera.
TEST(RealityRotation, AgreesWithTheMatrixThatRealityCaptureWroteIntoAnXmpFile) {
  Mat3 of_xmp;
  of_xmp << 0.982594073038806, 0.185426733553445, -0.0112166890261935,  //
      -0.032113633044729, 0.11008102707942, -0.993403685341366,         //
      -0.18296885582437, 0.976472781986697, 0.114;
  const Mat3 rotation = RealityRotation(163.736597399311, 83.4154313461628, 174.386496244756);
  EXPECT_LE((rotation - of_xmp).cwiseAbs().maxCoeff(), 2e-4);
  EXPECT_LE((rotation - of_xmp).topRows<2>().cwiseAbs().maxCoeff(), 1e-13);
}

TEST(RealityCsv, OnlyTheFirstHeaderIsNoImage) {
  const LightField light_field = OpenedCsv("#cameras 2\n" + kCsvHeader + "#remark,1\n" +
                                           "name_1.jpg,0,0,0,0,0,0,27,0,0,0,0,0,0,0,0\n" +
                                           "name,1,0,0,0,0,0,27,0,0,0,0,0,0,0,0\n");
  EXPECT_EQ(light_field.image_names, (std::vector<std::string>{"name_1.jpg", "name"}));
}

TEST(RealityCsv, LengthsAreSharesOfTheLargerSide) {
  const LightField light_field =
      OpenedCsv(kCsvHeader + "a.jpg,1,2,3,0,90,0,27,0.01,-0.02,0,0,0,0,0,0\n");
  ASSERT_EQ(light_field.size(), 1u);
  const PinholeCamera camera = light_field.Camera({0});
  EXPECT_NEAR(camera.intrinsics.fx_px, 480, 1e-12);  // 27 / 36 of 640
  EXPECT_EQ(camera.intrinsics.fy_px, camera.intrinsics.fx_px);
  EXPECT_NEAR(camera.intrinsics.cx_px, 326.4, 1e-12);
  EXPECT_NEAR(camera.intrinsics.cy_px, 227.2, 1e-12);
  EXPECT_EQ(camera.intrinsics.width_px, 640);
  EXPECT_LE((camera.CentreWorld() - Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LE((camera.ForwardWorld() - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_FALSE(camera.intrinsics.has_distortion());
}

TEST(RealityCsv, TheTangentialCoefficientsAreExchangedInOpenCv) {
  using enum DistortionModel;
  const LightField light_field =
      OpenedCsv(kCsvHeader + "a.jpg,0,0,0,0,0,0,27,0,0,0.1,0.2,0.3,0,0.01,0.02\n" +
                "b.jpg,0,0,0,0,0,0,27,0,0,0.1,0.2,0.3,0.4,0.01,0.02\n");
  EXPECT_EQ(light_field.Camera({0}).intrinsics.distortion,
            (Distortion{kRadialTangential, {0.1, 0.2, 0.02, 0.01, 0.3}}));
  EXPECT_EQ(light_field.Camera({1}).intrinsics.distortion,
            (Distortion{kBrown, {0.1, 0.2, 0.02, 0.01, 0.3, 0.4}}));
}

TEST(RealityCsv, ColumnsMayHaveOtherNamesAndAnotherOrder) {
  const LightField light_field = OpenedCsv(
      "\xEF\xBB\xBF#cameras 1\r\n"
      "#name, yaw, pitch, roll, x, y, z, f, px, py, k1, k2, k3, k4, t1, t2, more\r\n"
      "\r\na.jpg, 90, 90, 0, 4, 5, 6, 36, 0, 0, 0, 0, 0, 0, 0, 0, x\r\n");
  ASSERT_EQ(light_field.size(), 1u);
  EXPECT_LE((light_field.Camera({0}).ForwardWorld() - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LE((light_field.Camera({0}).CentreWorld() - Vec3(4, 5, 6)).norm(), 1e-14);
}

TEST(RealityCsv, TheOpenCvFormStatesMatricesAndPixels) {
  const LightField light_field = OpenedCsv(
      "#name,tx,ty,tz,R00,R01,R02,R10,R11,R12,R20,R21,R22,f_pix,px_pix,py_pix,k1,k2,t2,t1,k3,k4 "
      "(R = [Rij] in row major ordering, f in pixels)\n"
      "a.jpg,1,2,3,1,0,0,0,0,-1,0,1,0,500,310,245,0.1,0.2,0.02,0.01,0.3,0.4\n");
  const PinholeCamera camera = light_field.Camera({0});
  EXPECT_EQ(camera.cam_from_world.translation, Vec3(1, 2, 3));
  EXPECT_EQ(camera.ForwardWorld(), Vec3(0, 1, 0));
  EXPECT_EQ(camera.intrinsics.fx_px, 500);
  EXPECT_EQ(camera.intrinsics.cx_px, 310);
  EXPECT_EQ(camera.intrinsics.distortion,
            (Distortion{DistortionModel::kBrown, {0.1, 0.2, 0.02, 0.01, 0.3, 0.4}}));
}

TEST(RealityCsv, K1AloneMayBeThatOfTheDivisionModel) {
  testing::internal::CaptureStderr();
  OpenedCsv(kCsvHeader + "a.jpg,0,0,0,0,0,0,27,0,0,-0.2,0,0,0,0,0\n");
  const std::string warning = testing::internal::GetCapturedStderr();
  EXPECT_NE(warning.find("Division"), std::string::npos) << warning;
}

TEST(RealityCsv, WhatCannotBeReadIsAnErrorThatNamesIt) {
  ExpectCsvError("", {"has no line with the names of the columns"});
  ExpectCsvError("a.jpg,1,2,3\n", {"has no line with the names of the columns"});
  ExpectCsvError("#name,lon,lat,alt,yaw,pitch,roll,f,px,py\na.jpg,1,2,3,0,0,0,27,0,0\n",
                 {"has no column x"});
  ExpectCsvError("#name,x,y,alt,yaw,pitch,roll\na.jpg,1,2,3,0,0,0\n", {"has no column f"});
  const std::string good = "a.jpg,1,2,3,0,90,0,27,0.01,-0.02,0,0,0,0,0,0\n";
  ExpectCsvError(kCsvHeader + good + "b.jpg,1,2,3,x,90,0,27,0,0,0,0,0,0,0,0\n",
                 {"line 3: heading is \"x\": expected a number"});
  ExpectCsvError(kCsvHeader + "b.jpg,1,2,nan,0,90,0,27,0,0,0,0,0,0,0,0\n", {"alt is \"nan\""});
  ExpectCsvError(kCsvHeader + "b.jpg,1,1e99,0,0,90,0,27,0,0,0,0,0,0,0,0\n", {"y is \"1e99\""});
  ExpectCsvError(kCsvHeader + "b.jpg,1,2\n", {"f is \"\""});
  ExpectCsvError(
      "#name,tx,ty,tz,R00,R01,R02,R10,R11,R12,R20,R21,R22,f_pix,px_pix,py_pix,k1,k2,t2,t1,k3,k4\n"
      "a.jpg,1,2,3,2,0,0,0,2,0,0,0,2,500,310,245,0,0,0,0,0,0\n",
      {"line 2: R00 to R22 is sheared or scaled"});
}

}  // namespace
}  // namespace lf
