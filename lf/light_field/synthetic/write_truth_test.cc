// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/write_truth.h"

#include <gtest/gtest.h>

#include "lf/light_field/synthetic/built_in_scenes.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class WriteTruthTest : public FolderTest {
 protected:
  WriteTruthTest() {
    for (int i = 0; i < 3; ++i) {
      RenderCamera camera;
      camera.pinhole.intrinsics =
          IntrinsicsFor(*FindBuiltInScene("lights"), 24 + i, 16);  // distinguished by their size
      camera.pinhole.cam_from_world.translation = {0, 0, 1};
      camera.aperture = {0.02, 5, 0};
      camera.focus_plane = FocusPlane(camera.pinhole, 0.75, {});
      cameras_.push_back(camera);
    }
  }
  Scene scene_{DescribeLights()};
  std::vector<RenderCamera> cameras_;
  ThreadPool pool_{2};
};

TEST_F(WriteTruthTest, EveryFrameIsAFileOfItsOwnWithFullPrecision) {
  ASSERT_TRUE(WriteTruth(scene_, cameras_, {4, 0}, folder_ / "truth", pool_));
  for (int i = 0; i < 3; ++i) {
    const auto name = "frame_000" + std::to_string(i + 1) + ".exr";
    const StoredImage stored = *ReadImage(folder_ / "truth" / name);
    const auto& read = std::get<Image<float>>(stored);
    const RenderCamera& camera = cameras_[static_cast<size_t>(i)];
    const Image<float> picture = ThinLensPhotograph(scene_, camera, {4, 0}, pool_);
    const Image<float> depths = DepthsSeen(scene_, camera.pinhole, pool_);
    ASSERT_EQ(read.channels(), 4);
    for (int y = 0; y < read.height(); ++y)
      for (int x = 0; x < read.width(); ++x) {
        for (int c = 0; c < 3; ++c) EXPECT_EQ(read.at(x, y, c), picture.at(x, y, c));
        EXPECT_EQ(read.at(x, y, 3), depths.at(x, y));
      }
  }
}

TEST_F(WriteTruthTest, AFrameOfInstantsIsTheirMean) {
  cameras_ = {cameras_[0], cameras_[0], cameras_[2], cameras_[2]};
  cameras_[3].pinhole.cam_from_world.translation.x() += 0.05;
  ASSERT_TRUE(WriteTruth(scene_, cameras_, {4, 0}, folder_, pool_, Surroundings::kShown, {}, 2));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "frame_0003.exr"));
  const auto stored = std::get<Image<float>>(*ReadImage(folder_ / "frame_0002.exr"));
  const Image<float> first = ThinLensPhotograph(scene_, cameras_[2], {4, 0}, pool_);
  const Image<float> second = ThinLensPhotograph(scene_, cameras_[3], {4, 0}, pool_);
  EXPECT_NE(first.pixels(), second.pixels());
  const Image<float> depths = DepthsSeen(scene_, cameras_[3].pinhole, pool_);
  for (int y = 0; y < stored.height(); ++y)
    for (int x = 0; x < stored.width(); ++x) {
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(
            stored.at(x, y, c),
            static_cast<float>((static_cast<double>(first.at(x, y, c)) + second.at(x, y, c)) / 2));
      ASSERT_EQ(stored.at(x, y, 3), depths.at(x, y));
    }
}

TEST_F(WriteTruthTest, StoppedItKeepsTheFramesThatAreDone) {
  const Result<void> stopped =
      WriteTruth(scene_, cameras_, {1, 0}, folder_, pool_, Surroundings::kShown,
                 [](size_t done) { return done < 2; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted);
  EXPECT_NE(stopped.error().message.find("after 2 of 3 frames"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "frame_0002.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "frame_0003.exr"));
}

}  // namespace
}  // namespace lf
