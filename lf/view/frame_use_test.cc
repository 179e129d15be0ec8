// SPDX-License-Identifier: Apache-2.0
#include "lf/view/frame_use.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "lf/view/scene_text.h"
#include "lf/view/test_grid.h"

namespace lf {
namespace {

NeedsOptions Unweighted() {
  NeedsOptions options;
  options.lens_weights = LensWeights::kNone;
  return options;
}

size_t Count(const FrameUse& use, CameraUse wanted) {
  return static_cast<size_t>(std::count(use.of_cameras.begin(), use.of_cameras.end(), wanted));
}

TEST(UseOfCameras, UsedAreThoseThatSelectionTakes) {
  const LightField field = testing::GridField();
  const ImageIndex index(field);
  ThreadPool pool(2);
  const RenderCamera frame = testing::GridFrame();
  const FrameUse use = UseOfCameras(index, frame, Unweighted(), pool);
  const auto selected = SelectImages(index, {&frame, 1}, {}, pool);
  ASSERT_EQ(use.used.size(), selected.size());
  for (size_t i = 0; i < selected.size(); ++i) {
    EXPECT_EQ(use.used[i].id, selected[i].id);
    EXPECT_EQ(use.of_cameras[selected[i].id.value], CameraUse::kUsed);
  }
  EXPECT_EQ(Count(use, CameraUse::kUsed), selected.size());
  EXPECT_EQ(Count(use, CameraUse::kLimit) + Count(use, CameraUse::kNoWeight), 0u);
}

// As in Figure 5.1 of the thesis, the lens is in the plane of the LF cameras.
TEST(UseOfCameras, OfATriangularApertureAreATriangle) {
  const LightField field = testing::GridField();
  const ImageIndex index(field);
  ThreadPool pool(1);
  const RenderCamera frame = testing::GridFrame(3);
  const FrameUse use = UseOfCameras(index, frame, Unweighted(), pool);
  for (uint32_t i = 0; i < field.size(); ++i) {
    const Vec3 centre = field.Camera(LfImageId{i}).CentreWorld();
    const Vec3 in_lens = frame.pinhole.cam_from_world * centre;
    const bool is_in_triangle = Contains(frame.aperture, Vec2(in_lens.x(), -in_lens.y()));
    EXPECT_EQ(use.of_cameras[i] == CameraUse::kUsed, is_in_triangle) << centre.transpose();
  }
}

TEST(UseOfCameras, TheOthersHaveReasons) {
  LightField field = testing::GridField();
  const uint32_t middle = 220;
  field.cameras[middle].cam_from_world = *LookAlong({0, 0, 0}, {0, 0, -1}, {0, -1, 0});
  field.cameras[middle + 1].cam_from_world = *LookAlong({0.005, 0, 0}, {0.2, 0, 1}, {0, -1, 0});
  const ImageIndex index(field);
  ThreadPool pool(1);
  NeedsOptions options = Unweighted();
  options.select.max_angle_rad = 0.1;
  FrameUse use = UseOfCameras(index, testing::GridFrame(), options, pool);
  EXPECT_EQ(use.of_cameras[0], CameraUse::kOutside);
  EXPECT_EQ(use.of_cameras[middle + 1], CameraUse::kAngle);
  options.select.max_angle_rad.reset();
  options.max_image_count = 20;
  use = UseOfCameras(index, testing::GridFrame(), options, pool);
  EXPECT_EQ(use.of_cameras[middle], CameraUse::kSeesNone);
  EXPECT_EQ(Count(use, CameraUse::kUsed), 20u);
  EXPECT_GT(Count(use, CameraUse::kLimit), 50u);
}

TEST(SceneText, HasALineForEverythingThatStandsSomewhere) {
  const LightField field = testing::GridField();
  CameraPath path;
  path.cameras = {testing::GridFrame(), testing::GridFrame(3)};
  ThreadPool pool(1);
  std::string text;
  const auto emit = [&](const std::string& part) -> Result<void> {
    text += part;
    return {};
  };
  ASSERT_TRUE(WriteSceneText(field, path, {FrameId{1}, FrameId{2}}, ShuffledRanks(field.size(), 0),
                             Unweighted(), pool, emit));
  const auto count = [&](const std::string& word) {
    size_t lines = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      lines += at == 0 || text[at - 1] == '\n' ? 1 : 0;
    return lines;
  };
  EXPECT_EQ(count("lf_camera "), 441u);
  EXPECT_EQ(count("render_camera "), 2u);
  EXPECT_GT(count("collected 1 "), count("collected 2 "));
  EXPECT_NE(text.find("\nlf_camera 220 0 0 0\n"), std::string::npos);
  EXPECT_NE(text.find("\ncollected 2 220 "), std::string::npos);
}

}  // namespace
}  // namespace lf
