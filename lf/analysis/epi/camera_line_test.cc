// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/epi/camera_line.h"

#include <gtest/gtest.h>

#include <string>

#include "lf/core/random.h"

namespace lf {
namespace {

void AddCamera(LightField* light_field, const Vec3& centre_world, const Mat3& rotation) {
  LfCamera camera;
  camera.cam_from_world = {rotation, -(rotation * centre_world)};
  light_field->cameras.push_back(camera);
  light_field->image_names.push_back(std::to_string(light_field->cameras.size() - 1) + ".png");
}

LightField EmptyField() {
  LightField light_field;
  light_field.intrinsics.push_back({100, 100, 32, 24, 0, 64, 48});
  return light_field;
}

// A grid of `columns` x `rows` cameras, 1 apart, whose rows are turned by an angle about the
// optical axis of the cameras.
LightField Grid(int columns, int rows, double angle_rad) {
  LightField light_field = EmptyField();
  const Mat3 turn = Eigen::AngleAxisd(angle_rad, Vec3::UnitZ()).toRotationMatrix();
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u)
      AddCamera(&light_field, turn * Vec3(u, v, 0), Mat3::Identity());
  return light_field;
}

std::vector<uint32_t> Numbers(const CameraLine& line) {
  std::vector<uint32_t> numbers;
  for (const LfImageId id : line.ids) numbers.push_back(id.value);
  return numbers;
}

TEST(CameraLine, IsARowOrAColumnOfAGrid) {
  const LightField grid = Grid(4, 3, 0);
  const auto row = FindCameraLine(grid, LfImageId{5}, LineKind::kRow, std::nullopt);
  ASSERT_TRUE(row);
  EXPECT_EQ(Numbers(*row), (std::vector<uint32_t>{4, 5, 6, 7}));
  EXPECT_EQ(row->positions_w, (std::vector<double>{-1, 0, 1, 2}));
  EXPECT_TRUE(row->rotation.isIdentity(1e-12));
  EXPECT_TRUE(row->is_even);
  EXPECT_DOUBLE_EQ(row->pitch_w, 1);
  const auto column = FindCameraLine(grid, LfImageId{5}, LineKind::kColumn, std::nullopt);
  ASSERT_TRUE(column);
  EXPECT_EQ(Numbers(*column), (std::vector<uint32_t>{1, 5, 9}));
  EXPECT_TRUE(column->rotation.isIdentity(1e-12));
}

// The ends of the row are 1.7 beside the axis of the cameras, more than the distance of two rows.
TEST(CameraLine, FollowsRowsThatAreTurnedAgainstTheCameras) {
  constexpr double kAngle_rad = 0.035;
  const LightField grid = Grid(101, 5, kAngle_rad);
  const auto row = FindCameraLine(grid, LfImageId{2 * 101 + 50}, LineKind::kRow, std::nullopt);
  ASSERT_TRUE(row);
  ASSERT_EQ(row->ids.size(), 101u);
  for (uint32_t i = 0; i < 101; ++i) EXPECT_EQ(row->ids[i].value, 2 * 101 + i);
  // The view is turned with the row.
  EXPECT_NEAR(row->rotation(0, 1), std::sin(kAngle_rad), 1e-12);
  EXPECT_NEAR((row->rotation * row->rotation.transpose() - Mat3::Identity()).norm(), 0, 1e-12);
}

TEST(CameraLine, HasTheCamerasWithinTheTolerance) {
  LightField scattered = EmptyField();
  for (uint32_t i = 0; i < 300; ++i) {
    const auto random = [i](uint32_t axis) {
      return static_cast<double>(RandomBits(7, axis, i) % 100'000) / 1e5;
    };
    AddCamera(&scattered, {10 * random(0), 10 * random(1), 0.1 * random(2)}, Mat3::Identity());
  }
  const auto line = FindCameraLine(scattered, LfImageId{3}, LineKind::kRow, 0.5);
  ASSERT_TRUE(line);
  EXPECT_GT(line->ids.size(), 10u);
  EXPECT_FALSE(line->is_even);
  for (size_t i = 0; i < line->ids.size(); ++i) {
    EXPECT_LE(line->distances_w[i], 0.5);
    if (i > 0) {
      EXPECT_GT(line->positions_w[i], line->positions_w[i - 1]);
    }
  }
}

TEST(CameraLine, HasOneCameraForEachPosition) {
  LightField brackets = Grid(3, 1, 0);
  brackets.encoding.masks_clipped = true;
  AddCamera(&brackets, Vec3(1, 0, 0), Mat3::Identity());
  const auto row = FindCameraLine(brackets, LfImageId{0}, LineKind::kRow, std::nullopt);
  ASSERT_TRUE(row);
  EXPECT_EQ(Numbers(*row), (std::vector<uint32_t>{0, 1, 2}));
}

TEST(CameraLine, NeedsASecondCamera) {
  const auto alone = FindCameraLine(Grid(1, 3, 0), LfImageId{1}, LineKind::kRow, std::nullopt);
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().kind, ErrorKind::kInput);
  EXPECT_NE(alone.error().message.find("1.png: stands in no row"), std::string::npos);
}

TEST(CameraLine, IsNotOneThatTheCamerasLookAlong) {
  LightField dolly = EmptyField();
  // The mean right axis is along z because half of the cameras are turned to the left.
  const Mat3 left = Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitY()).toRotationMatrix();
  for (int i = 0; i < 5; ++i) AddCamera(&dolly, Vec3(0, 0, i), Mat3::Identity());
  const auto row = FindCameraLine(dolly, LfImageId{0}, LineKind::kRow, 10);
  ASSERT_FALSE(row);
  EXPECT_NE(row.error().message.find("look along it"), std::string::npos);
  LightField turned = EmptyField();
  for (int i = 0; i < 5; ++i) AddCamera(&turned, Vec3(0, 0, i), left);
  EXPECT_TRUE(FindCameraLine(turned, LfImageId{0}, LineKind::kRow, 10));
}

TEST(LfImageName, IsThatOfTheCalibrationOrOfItsFile) {
  LightField light_field = Grid(3, 1, 0);
  light_field.image_names = {"a/left.png", "a/middle.png", "b/middle.png"};
  EXPECT_EQ(LfImageNamed(light_field, "b/middle.png")->value, 2u);
  EXPECT_EQ(LfImageNamed(light_field, "left.png")->value, 0u);
  EXPECT_NE(LfImageNamed(light_field, "middle.png").error().message.find("2 LF images"),
            std::string::npos);
  EXPECT_NE(LfImageNamed(light_field, "a/midle.png").error().message.find("a/middle.png"),
            std::string::npos);
}

TEST(LfImageName, IsOfARecordedLfImage) {
  LightField light_field = Grid(5, 1, 0);
  light_field.image_names = {"0.png", "1.png", "virtual/2.png", "3.png", "4.png"};
  light_field.cameras[2].is_virtual = true;
  EXPECT_EQ(LfImageNamed(light_field, "3.png")->value, 3u);
  for (const char* name : {"virtual/2.png", "2.png"}) {
    const auto found = LfImageNamed(light_field, name);
    ASSERT_FALSE(found) << name;
    EXPECT_EQ(found.error().kind, ErrorKind::kUsage);
    for (const char* word : {"virtual/2.png: is a virtual LF image", "1.png", "3.png"})
      EXPECT_NE(found.error().message.find(word), std::string::npos) << found.error().message;
  }
}

}  // namespace
}  // namespace lf
