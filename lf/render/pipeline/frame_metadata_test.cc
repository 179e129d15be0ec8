// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/frame_metadata.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "lf/camera/testing_scenes.h"

namespace lf {
namespace {

const MetadataValue* Find(const ImageMetadata& metadata, const std::string& name) {
  for (const auto& [key, value] : metadata)
    if (key == name) return &value;
  return nullptr;
}

template <class T>
T Get(const ImageMetadata& metadata, const std::string& name) {
  const MetadataValue* const value = Find(metadata, name);
  EXPECT_TRUE(value != nullptr && std::holds_alternative<T>(*value)) << name;
  return std::get<T>(*value);
}

// Multiplies the row vector (point, 1) by a matrix of an EXR file.
Eigen::RowVector4d Times(const Vec3& point, const std::array<float, 16>& rows) {
  Eigen::RowVector4d result = Eigen::RowVector4d::Zero();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      result[column] += (row < 3 ? point[row] : 1) * rows[4 * row + column];
  return result;
}

RenderCamera TurnedCamera() {
  RenderCamera camera;
  camera.pinhole.intrinsics = {900, 900, 490, 265, 0, 960, 540};
  camera.pinhole.cam_from_world =
      *LookAlong(Vec3(0.4, -1.2, 2.5), Vec3(0.3, 0.2, -1), Vec3(0.2, 1, 0.1));
  camera.aperture.radius_w = 0.02;
  camera.focal_length_w = 0.05;
  camera.sensor_width_w = 0.036;
  camera.focus_distance_w = 1.7;
  camera.unit_m = 0.5;
  return camera;
}

TEST(StandardAttributes, WorldToNdcGivesThePlaceInTheFrame) {
  const RenderCamera camera = TurnedCamera();
  const ImageMetadata attributes = StandardAttributes(FrameId{3}, camera, 25, ColourSpace::kRec709);
  const auto matrix = Get<std::array<float, 16>>(attributes, "worldToNDC");
  for (const Vec3& place_px : {Vec3(0, 0, 1), Vec3(960, 540, 7), Vec3(12, 500, 1.7)}) {
    const Vec3 point = RayOfPixel(camera.pinhole, place_px.x(), place_px.y()).At(place_px.z());
    const Eigen::RowVector4d ndc = Times(point, matrix);
    EXPECT_NEAR(960 * ndc[0] / ndc[3], place_px.x(), 1e-3);
    EXPECT_NEAR(540 * ndc[1] / ndc[3], place_px.y(), 1e-3);
    EXPECT_NEAR(ndc[3], place_px.z(), 1e-5);
    EXPECT_NEAR(ndc[2], place_px.z() - 1.7, 1e-5);
  }
}

TEST(StandardAttributes, CameraAxesAreRightUpAndForward) {
  const RenderCamera camera = TurnedCamera();
  const ImageMetadata attributes = StandardAttributes(FrameId{3}, camera, 25, ColourSpace::kRec709);
  const auto matrix = Get<std::array<float, 16>>(attributes, "worldToCamera");
  const PinholeCamera& pinhole = camera.pinhole;
  const Vec3 point = pinhole.CentreWorld() + 2 * pinhole.RightWorld() + 3 * pinhole.UpWorld() +
                     4 * pinhole.ForwardWorld();
  EXPECT_LT((Times(point, matrix) - Eigen::RowVector4d(2, 3, 4, 1)).norm(), 1e-5);
}

TEST(StandardAttributes, LensAndSensorAreInMillimetresAndTheFocusIsInMetres) {
  RenderCamera camera = TurnedCamera();
  const ImageMetadata attributes = StandardAttributes(FrameId{3}, camera, 25, ColourSpace::kAcesCg);
  EXPECT_EQ(Get<int>(attributes, "imageCounter"), 3);
  EXPECT_EQ(Get<FrameRate>(attributes, "framesPerSecond").per_second, 25);
  EXPECT_FLOAT_EQ(Get<float>(attributes, "focus"), 0.85F);
  EXPECT_FLOAT_EQ(Get<float>(attributes, "aperture"), 1.25F);
  EXPECT_FLOAT_EQ(Get<float>(attributes, "nominalFocalLength"), 25);
  EXPECT_FLOAT_EQ(Get<float>(attributes, "effectiveFocalLength"), 25);
  EXPECT_FLOAT_EQ(Get<float>(attributes, "pinholeFocalLength"), 18 * 900 / 960.0F);
  const auto sensor = Get<std::array<float, 2>>(attributes, "sensorOverallDimensions");
  EXPECT_FLOAT_EQ(sensor[0], 18);
  EXPECT_FLOAT_EQ(sensor[1], 18 * 540 / 960.0F);
  EXPECT_FLOAT_EQ(Get<float>(attributes, "pixelAspectRatio"), 1);
  EXPECT_FLOAT_EQ(Get<float>(attributes, "screenWindowWidth"), 960 / 900.0F);
  // The x axis of the screen window points to the left: the principal point right of the middle of
  // the frame moves the window to the left.
  const auto centre = Get<std::array<float, 2>>(attributes, "screenWindowCenter");
  EXPECT_FLOAT_EQ(centre[0], 10 / 900.0F);
  EXPECT_FLOAT_EQ(centre[1], -5 / 900.0F);
  EXPECT_FLOAT_EQ((Get<std::array<float, 8>>(attributes, "chromaticities")[0]), 0.713F);
  camera.aperture.radius_w = 0;
  EXPECT_EQ(Find(StandardAttributes(FrameId{3}, camera, 25, ColourSpace::kRec709), "aperture"),
            nullptr);
}

TEST(FileMetadata, StatesTheShutter) {
  PlateNotes notes;
  notes.camera = TurnedCamera();
  notes.fps = 25;
  const ImageMetadata without = FileMetadata(notes, FrameFormat::kExrHalf, ColourSpace::kRec709);
  notes.shutter = FrameShutter{{180, 8}, ""};
  const ImageMetadata with = FileMetadata(notes, FrameFormat::kExrHalf, ColourSpace::kRec709);
  EXPECT_EQ(with.size(), without.size() + 3);
  EXPECT_EQ(Get<double>(with, "lf:shutter_angle_deg"), 180);
  EXPECT_EQ(Get<int>(with, "lf:shutter_samples"), 8);
  EXPECT_EQ(Get<float>(with, "expTime"), 0.02F);
  EXPECT_EQ(Find(without, "expTime"), nullptr);
}

TEST(FileMetadata, OnlyExrFilesHaveStandardAttributes) {
  PlateNotes notes;
  notes.camera = TurnedCamera();
  for (const FrameFormat format :
       {FrameFormat::kExrHalf, FrameFormat::kExrFloat, FrameFormat::kPng8, FrameFormat::kPng16}) {
    const ImageMetadata metadata = FileMetadata(notes, format, ColourSpace::kRec709);
    EXPECT_NE(Find(metadata, "lf:focus_distance_w"), nullptr);
    EXPECT_EQ(Find(metadata, "focus") != nullptr, IsExr(format));
  }
}

}  // namespace
}  // namespace lf
