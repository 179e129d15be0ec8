// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_metashape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

const std::string kFrame =
    R"(<sensor id="0" label="A" type="frame"><resolution width="600" height="400"/>
       <calibration type="frame" class="initial"><resolution width="600" height="400"/><f>400</f>
       </calibration>
       <calibration type="frame" class="adjusted"><resolution width="600" height="400"/><f>500</f>
       <cx>3</cx><cy>-4</cy><b1>2</b1><b2>0.5</b2><k1>0.1</k1><k2>0.2</k2><k3>0.3</k3><p1>0.01</p1>
       <p2>0.02</p2></calibration></sensor>)";

const std::string kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";

std::string CameraWith(int id, const std::string& attributes, const std::string& transform) {
  return "<camera id=\"" + std::to_string(id) + "\" label=\"" + std::to_string(id) + "\" " +
         attributes + ">" + (transform.empty() ? "" : "<transform>" + transform + "</transform>") +
         "</camera>";
}

std::string ChunkWith(const std::string& sensors, const std::string& cameras,
                      const std::string& rest = "") {
  return "<?xml version=\"1.0\"?><document version=\"2.0.0\"><chunk label=\"C\"><sensors>" +
         sensors + "</sensors>" + rest + "<cameras>" + cameras + "</cameras></chunk></document>";
}

ExportedCameras ParsedMetashape(const std::string& text) {
  Result<ExportedCameras> cameras = ParseMetashape(text, "f/cameras.xml");
  EXPECT_TRUE(cameras) << cameras.error().message << "\n" << text;
  return cameras ? *std::move(cameras) : ExportedCameras();
}

void ExpectMetashapeError(const std::string& text, const std::vector<std::string>& parts) {
  const Result<ExportedCameras> cameras = ParseMetashape(text, "f/cameras.xml");
  ASSERT_FALSE(cameras) << text;
  const std::string& message = cameras.error().message;
  EXPECT_TRUE(message.starts_with("f/cameras.xml: ")) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

// Metashape's formula, written as in its manual.
Vec2 PixelByManual(const Vec3& point_cam) {
  const double x = point_cam.x() / point_cam.z(), y = point_cam.y() / point_cam.z();
  const double r2 = x * x + y * y;
  const double radial = 1 + 0.1 * r2 + 0.2 * r2 * r2 + 0.3 * r2 * r2 * r2;
  const double xd = x * radial + 0.01 * (r2 + 2 * x * x) + 2 * 0.02 * x * y;
  const double yd = y * radial + 0.02 * (r2 + 2 * y * y) + 2 * 0.01 * x * y;
  return {600 * 0.5 + 3 + xd * 500 + xd * 2 + yd * 0.5, 400 * 0.5 - 4 + yd * 500};
}

TEST(Metashape, TheAdjustedLensFollowsTheManual) {
  const ExportedCameras cameras =
      ParsedMetashape(ChunkWith(kFrame, CameraWith(0, "sensor_id=\"0\"", kIdentity)));
  ASSERT_EQ(cameras.images.size(), 1u);
  EXPECT_EQ(cameras.images[0].name, "0");
  EXPECT_EQ(cameras.folder, "f");
  const Intrinsics& k = cameras.images[0].intrinsics;
  EXPECT_EQ(k.width_px, 600);
  EXPECT_EQ(k.height_px, 400);
  for (const Vec3& point : {Vec3(0.3, -0.2, 1), Vec3(-0.1, 0.25, 0.5), Vec3(0, 0, 2)}) {
    const Vec2 distorted = *DistortionMap(k.distortion).Distort(point);
    const Vec3 pixel = k.Matrix() * Vec3(distorted.x(), distorted.y(), 1);
    EXPECT_LE((pixel.head<2>() - PixelByManual(point)).norm(), 1e-9);
  }
}

Distortion LensOf(const std::string& type, const std::string& coefficients) {
  const ExportedCameras cameras = ParsedMetashape(
      ChunkWith("<sensor id=\"0\" type=\"" + type +
                    "\"><resolution width=\"6\" height=\"4\"/><calibration><f>5</f>" +
                    coefficients + "</calibration></sensor>",
                CameraWith(0, "sensor_id=\"0\"", kIdentity)));
  return cameras.images.empty() ? Distortion() : cameras.images[0].intrinsics.distortion;
}

TEST(Metashape, EveryLensGetsTheModelThatHasItsTerms) {
  using enum DistortionModel;
  EXPECT_EQ(LensOf("frame", ""), Distortion{});
  EXPECT_EQ(LensOf("frame", "<p1>1</p1><p2>2</p2>"), (Distortion{kRadialTangential, {0, 0, 2, 1}}));
  EXPECT_EQ(LensOf("frame", "<k1>1</k1><k2>2</k2><k3>3</k3><k4>4</k4><p1>5</p1><p2>6</p2>"),
            (Distortion{kBrown, {1, 2, 6, 5, 3, 4}}));
  EXPECT_EQ(LensOf("fisheye", "<k1>1</k1><k4>4</k4>"), (Distortion{kFisheye, {1, 0, 0, 4}}));
  EXPECT_EQ(LensOf("equidistant_fisheye", ""), (Distortion{kFisheye, {}}));
  EXPECT_EQ(LensOf("fisheye", "<k3>3</k3><p1>5</p1>"),
            (Distortion{kThinPrism, {0, 0, 0, 5, 3, 0}}));
}

TEST(Metashape, TransformsAreChunkFromCameraAndTheComponentPlacesTheChunk) {
  // Turned by 90 degrees about the chunk's z axis: the camera's x is the chunk's y.
  const std::string turned = "0 -1 0 1 1 0 0 2 0 0 1 3 0 0 0 1";
  const std::string component =
      R"(<components active_id="0"><component id="0"><transform>
         <rotation>1 0 0 0 0 -1 0 1 0</rotation><translation>10 20 30</translation>
         <scale>2</scale></transform></component></components>)";
  const ExportedCameras cameras = ParsedMetashape(
      ChunkWith(kFrame, CameraWith(0, "sensor_id=\"0\" component_id=\"0\"", turned), component));
  ASSERT_EQ(cameras.images.size(), 1u);
  const RigidTransform world_from_cam = cameras.images[0].cam_from_world.Inverse();
  // chunk (1, 2, 3) is turned to (1, -3, 2), scaled to (2, -6, 4), and moved.
  EXPECT_LE((world_from_cam.translation - Vec3(12, 14, 34)).norm(), 1e-12);
  // The camera looks along the chunk's z, which is the world's -y.
  EXPECT_LE((world_from_cam.rotation * Vec3(0, 0, 1) - Vec3(0, -1, 0)).norm(), 1e-12);
  EXPECT_LE((world_from_cam.rotation * Vec3(1, 0, 0) - Vec3(0, 0, 1)).norm(), 1e-12);
}

TEST(Metashape, OlderFilesPlaceTheWholeChunk) {
  const ExportedCameras cameras = ParsedMetashape(
      ChunkWith(kFrame, CameraWith(0, "sensor_id=\"0\"", "1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1"),
                "<transform><rotation>1 0 0 0 1 0 0 0 1</rotation><translation>0 5 0</translation>"
                "<scale>3</scale></transform>"));
  EXPECT_LE((cameras.images[0].cam_from_world.translation + Vec3(3, 5, 0)).norm(), 1e-12);
}

TEST(Metashape, CamerasOfARigStandRelativeToTheirMaster) {
  const std::string slave =
      R"(<sensor id="1" type="frame" master_id="0"><resolution width="60" height="40"/>
         <calibration><f>50</f></calibration><rotation>0 0 1 0 1 0 -1 0 0</rotation>
         <location>0.5 0 0</location></sensor>)";
  const ExportedCameras cameras = ParsedMetashape(ChunkWith(
      kFrame + slave, CameraWith(0, "sensor_id=\"0\"", "1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1") +
                          CameraWith(1, "sensor_id=\"1\" master_id=\"0\"", "")));
  ASSERT_EQ(cameras.images.size(), 2u);
  const RigidTransform world_from_cam = cameras.images[1].cam_from_world.Inverse();
  EXPECT_LE((world_from_cam.translation - Vec3(1.5, 2, 3)).norm(), 1e-12);
  // The third column of the rotation is the optical axis in the axes of the master.
  EXPECT_LE((world_from_cam.rotation * Vec3(0, 0, 1) - Vec3(1, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(cameras.images[1].intrinsics.width_px, 60);
}

// The master of the cameras may be another one than that of the sensors.
TEST(Metashape, TheMasterOfARigMayBeASlaveSensor) {
  const std::string slave =
      R"(<sensor id="1" type="frame" master_id="0"><resolution width="60" height="40"/>
         <calibration><f>50</f></calibration><rotation>1 0 0 0 1 0 0 0 1</rotation>
         <location>0.5 0 0</location></sensor>)";
  const ExportedCameras cameras = ParsedMetashape(
      ChunkWith(kFrame + slave, CameraWith(0, "sensor_id=\"1\"", kIdentity) +
                                    CameraWith(1, "sensor_id=\"0\" master_id=\"0\"", "")));
  ASSERT_EQ(cameras.images.size(), 2u);
  EXPECT_LE((cameras.images[1].cam_from_world.Inverse().translation - Vec3(-0.5, 0, 0)).norm(),
            1e-12);
}

std::string WarningOf(const std::string& text, size_t count) {
  testing::internal::CaptureStderr();
  const ExportedCameras cameras = ParsedMetashape(text);
  EXPECT_EQ(cameras.images.size(), count);
  return testing::internal::GetCapturedStderr();
}

TEST(Metashape, CamerasWithoutAPoseAreLeftOutAndCounted) {
  const std::string frame = "sensor_id=\"0\"";
  const std::string warning =
      WarningOf(ChunkWith(kFrame, CameraWith(0, frame, kIdentity) + CameraWith(1, frame, "") +
                                      CameraWith(2, frame + " enabled=\"false\"", kIdentity) +
                                      "<group id=\"0\">" + CameraWith(3, frame, kIdentity) +
                                      CameraWith(4, frame + " enabled=\"0\"", "") + "</group>"),
                2);
  EXPECT_NE(warning.find("3 of 5 cameras are left out: 2 disabled, 1 not aligned"),
            std::string::npos)
      << warning;
}

TEST(Metashape, ComponentsThatAreNotPlacedAreOtherWorlds) {
  const std::string components =
      R"(<components active_id="0"><component id="0"/><component id="1"/></components>)";
  const auto camera = [](int id, int component) {
    return CameraWith(id, "sensor_id=\"0\" component_id=\"" + std::to_string(component) + "\"",
                      kIdentity);
  };
  const std::string warning =
      WarningOf(ChunkWith(kFrame, camera(0, 0) + camera(1, 1) + camera(2, 1), components), 2);
  EXPECT_NE(warning.find("1 of 3 cameras are left out: 1 in components"), std::string::npos)
      << warning;
  EXPECT_NE(warning.find("in the unit of the chunk, whose length is not known"), std::string::npos);
  const std::string placed =
      R"(<components><component id="0"><transform><scale>2</scale></transform></component>
         <component id="1"><transform><scale>3</scale></transform></component></components>
         <reference>GEOGCS["WGS 84",DATUM[]]</reference>)";
  const std::string unit = WarningOf(ChunkWith(kFrame, camera(0, 0) + camera(1, 1), placed), 2);
  EXPECT_EQ(unit.find("left out"), std::string::npos) << unit;
  EXPECT_NE(unit.find("metres, in geocentric coordinates (\"WGS 84\")"), std::string::npos) << unit;
}

TEST(Metashape, WhatCannotBeReadIsAnErrorThatNamesIt) {
  const std::string camera = CameraWith(0, "sensor_id=\"0\"", kIdentity);
  const auto sensor = [](const std::string& inside, const std::string& type = "frame") {
    return "<sensor id=\"0\" label=\"A\" type=\"" + type +
           "\"><resolution width=\"6\" height=\"4\"/>" + inside + "</sensor>";
  };
  ExpectMetashapeError("<document/>", {"holds 0 chunks"});
  ExpectMetashapeError("<document><chunk/><chunk/></document>", {"holds 2 chunks"});
  ExpectMetashapeError(ChunkWith("", camera), {"camera 0 (0) has the sensor 0, which is not"});
  ExpectMetashapeError(ChunkWith(sensor(""), camera), {"sensor 0 (A) has no calibration: align"});
  ExpectMetashapeError(ChunkWith(sensor("<calibration/>"), camera), {"has no <f>"});
  ExpectMetashapeError(ChunkWith(sensor("<calibration><f>1e99</f></calibration>"), camera),
                       {"calibration/f is \"1e99\""});
  ExpectMetashapeError(ChunkWith(sensor("<calibration><f>nan</f></calibration>"), camera),
                       {"f is \"nan\""});
  ExpectMetashapeError(ChunkWith(sensor("<calibration><fx>1</fx></calibration>"), camera),
                       {"PhotoScan 1.1 or older"});
  ExpectMetashapeError(ChunkWith(sensor("<calibration><f>5</f><p3>1</p3></calibration>"), camera),
                       {"p3 is \"1\""});
  ExpectMetashapeError(
      ChunkWith(sensor("<calibration><f>5</f></calibration>", "spherical"), camera),
      {"is of the type \"spherical\": expected frame, fisheye", "Convert Images"});
  ExpectMetashapeError(
      ChunkWith(kFrame, CameraWith(0, "sensor_id=\"0\"", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1")),
      {"camera 0 (0)/transform", "last row 0 0 0 1"});
  ExpectMetashapeError(
      ChunkWith(kFrame, CameraWith(0, "sensor_id=\"0\"", "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1")),
      {"camera 0 (0)/transform is mirrored"});
  ExpectMetashapeError(ChunkWith(kFrame, CameraWith(0, "sensor_id=\"0\"", "1 0 0")),
                       {"expected 16 numbers"});
  ExpectMetashapeError(ChunkWith(kFrame, CameraWith(0, "sensor_id=\"0\" master_id=\"9\"", "")),
                       {"has the master 9, which is not in the file"});
  ExpectMetashapeError(ChunkWith(kFrame, camera, "<transform><scale>0</scale></transform>"),
                       {"scale is \"0\""});
}

using MetashapeFolder = FolderTest;

TEST_F(MetashapeFolder, EqualLabelsLeadToFoldersOfGroupsOrSensors) {
  const auto opened = [&](const std::string& group) {
    const std::string camera = CameraWith(7, "sensor_id=\"0\"", kIdentity);
    const std::string other =
        Replaced(CameraWith(8, "sensor_id=\"0\"", kIdentity), "label=\"8\"", "label=\"7\"");
    const std::filesystem::path file = folder_ / "cameras.xml";
    EXPECT_TRUE(WriteFileAtomically(
        file, ChunkWith(kFrame, "<group label=\"" + group + "\">" + camera + "</group>" + other)));
    return ReadMetashape(file, {});
  };
  for (const std::string& name : {std::string("A"), std::string("left")}) {
    std::filesystem::create_directories(folder_ / "photos" / name);
    ASSERT_TRUE(WriteFileAtomically(folder_ / "photos" / name / "7.jpg", "x"));
  }
  const Result<LightField> apart = opened("left");
  ASSERT_TRUE(apart) << apart.error().message;
  std::vector<std::string> names = apart->image_names;
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"photos/A/7.jpg", "photos/left/7.jpg"}));
  const Result<LightField> together = opened("A");
  ASSERT_FALSE(together);
  EXPECT_NE(together.error().message.find("several cameras have the image \"A/7\""),
            std::string::npos)
      << together.error().message;
}

TEST(Metashape, LensesThatNoImageHasMayBeOfAnyKind) {
  const ExportedCameras cameras = ParsedMetashape(ChunkWith(
      kFrame + "<sensor id=\"1\" type=\"spherical\"/>",
      CameraWith(0, "sensor_id=\"0\"", kIdentity) + CameraWith(1, "sensor_id=\"1\"", "")));
  EXPECT_EQ(cameras.images.size(), 1u);
}

}  // namespace
}  // namespace lf
