// SPDX-License-Identifier: Apache-2.0
#include "lf/view/scene_bytes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "lf/view/test_grid.h"

namespace lf {
namespace {

template <class T>
T At(const std::string& bytes, size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

// The LF cameras are 5 mm apart, and a thousand kilometres away from the world's origin.
TEST(SceneBytes, CamerasAreWhereTheyAre) {
  LightField field = testing::GridField();
  for (LfCamera& camera : field.cameras) camera.cam_from_world.translation.x() -= 1e6;
  EXPECT_NEAR(SceneOrigin(field).x(), 1e6, 1e-6);
  const std::string bytes = CamerasBytes(field);
  ASSERT_EQ(bytes.size(), 12 * field.size());
  EXPECT_FLOAT_EQ(At<float>(bytes, 12 * 20), 0.05f);
  EXPECT_FLOAT_EQ(At<float>(bytes, 12 * 20 + 4), -0.05f);
}

TEST(SceneBytes, FramesHaveTheirNumbers) {
  CameraPath path;
  path.cameras = {testing::GridFrame(5), testing::GridFrame(3)};
  const std::string bytes =
      FramesBytes(PathFrames(std::move(path)), std::vector<FrameId>{{1}, {2}});
  ASSERT_EQ(bytes.size(), 8 * kFrameNumbers * 2);
  const auto number = [&](size_t frame, size_t i) {
    return At<double>(bytes, 8 * (kFrameNumbers * frame + i));
  };
  EXPECT_EQ(number(0, 11), 1);       // the forward direction is z
  EXPECT_EQ(number(0, 12), 80);      // fx
  EXPECT_EQ(number(0, 16), 0.0301);  // radius
  EXPECT_EQ(number(0, 18), 5);       // blades
  EXPECT_EQ(number(1, 18), 3);
  EXPECT_EQ(number(1, 26), 1);  // focus distance
  EXPECT_EQ(number(1, 29), 80);
  EXPECT_EQ(number(1, 30), 60);
}

TEST(SceneBytes, UseTellsSharesAndReasons) {
  const LightField field = testing::GridField();
  const ImageIndex index(field);
  ThreadPool pool(1);
  const FrameUse use = UseOfCameras(index, testing::GridFrame(), {}, pool);
  const std::string bytes = FrameUseBytes(field, use);
  const size_t used = use.used.size();
  ASSERT_GT(used, 10u);
  ASSERT_EQ(bytes.size(), 16 + 8 * used + field.size());
  EXPECT_EQ(At<uint32_t>(bytes, 0), field.size());
  EXPECT_EQ(At<uint32_t>(bytes, 4), used);
  EXPECT_NEAR(At<float>(bytes, 8), 0.005, 0.001);
  EXPECT_EQ(At<uint32_t>(bytes, 16), use.used[0].id.value);
  const float share = At<float>(bytes, 16 + 4 * used);
  EXPECT_GT(share, 0.2f);
  EXPECT_LE(share, 1.0f);
  EXPECT_EQ(At<CameraUse>(bytes, 16 + 8 * used + use.used[0].id.value), CameraUse::kUsed);
}

TEST(SceneBytes, PicturesAreHalves) {
  GrowingPicture picture;
  picture.full_width_px = 6;
  picture.full_height_px = 4;
  picture.has_rays = true;
  picture.elements = Image<float>(3, 2, 4, 1.5f);
  const std::string bytes = PictureBytes(picture);
  ASSERT_EQ(bytes.size(), 32u + 3 * 2 * 4 * 2);
  EXPECT_EQ(At<uint32_t>(bytes, 0), 3u);
  EXPECT_EQ(At<uint32_t>(bytes, 12), 4u);
  EXPECT_EQ(At<uint16_t>(bytes, 32), 0x3E00);  // 1.5
}

}  // namespace
}  // namespace lf
