// SPDX-License-Identifier: Apache-2.0
#include "lf/view/watched_render.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "lf/film/develop/picture.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

class WatchedRenderTest : public FolderTest {
 protected:
  // Writes a frame whose elements (x, y) have R = x, G = y, B = 1, and x + y rays.
  void Write(const std::string& name,
             const std::array<const char*, 3>& count_channels = kCountChannels) {
    const int width = 6, height = 4;
    Image<float> colours(width, height, 3, 1.0f);
    Image<uint32_t> counts(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        colours.at(x, y, 0) = static_cast<float>(x);
        colours.at(x, y, 1) = static_cast<float>(y);
        counts.at(x, y) = static_cast<uint32_t>(x + y);
      }
    std::vector<ExrChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({{"RGB"[c]}, colours.view(), c});
    for (const char* const count_channel : count_channels)
      channels.push_back({count_channel, counts.view()});
    fs::create_directories((folder_ / name).parent_path());
    const auto written = WriteExr(folder_ / name, channels);
    ASSERT_TRUE(written) << written.error().message;
  }
};

TEST_F(WatchedRenderTest, FindsFinishedFramesAndTheNewestOfOthers) {
  Write("frame_0001.exr");
  Write("partial/frame_0001.exr");
  Write("partial/package-0001/frame_0003.exr");
  Write("partial/frame_0002.exr");
  Write("cluster/frame_0009.exr");
  Write("frame_x.exr");
  const auto frames = LookAtRender(folder_);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[0].picture, folder_ / "frame_0001.exr");
  EXPECT_TRUE(frames[0].is_finished);
  EXPECT_FALSE(frames[1].is_finished);
  EXPECT_EQ(frames[2].frame, FrameId{3});
  EXPECT_GT(frames[2].changed_ns, 0);
  EXPECT_TRUE(LookAtRender(folder_ / "nowhere").empty());
}

TEST_F(WatchedRenderTest, ReadsLightAndRays) {
  Write("frame_0001.exr");
  const auto picture = ReadGrowingPicture(folder_ / "frame_0001.exr", 3);
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->full_width_px, 6);
  EXPECT_TRUE(picture->has_rays);
  ASSERT_EQ(picture->elements.width(), 3);
  ASSERT_EQ(picture->elements.height(), 2);
  EXPECT_FLOAT_EQ(picture->elements.at(1, 1, 0), 2.5f);
  EXPECT_FLOAT_EQ(picture->elements.at(1, 1, 1), 2.5f);
  EXPECT_FLOAT_EQ(picture->elements.at(1, 1, 3), 5.0f);
}

TEST_F(WatchedRenderTest, FramesOfEarlierBuildsTellTheirRays) {
  Write("frame_0001.exr", kLayeredCountChannels);
  const auto picture = ReadGrowingPicture(folder_ / "frame_0001.exr", 3);
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_TRUE(picture->has_rays);
  EXPECT_FLOAT_EQ(picture->elements.at(1, 1, 3), 5.0f);
}

TEST_F(WatchedRenderTest, PngFilesTellNoRays) {
  const Image<uint8_t> white(4, 4, 3, 255);
  ASSERT_TRUE(WriteImage(folder_ / "frame_0001.png", white.view()));
  const auto picture = ReadGrowingPicture(folder_ / "frame_0001.png", 100);
  ASSERT_TRUE(picture);
  EXPECT_FALSE(picture->has_rays);
  EXPECT_FLOAT_EQ(picture->elements.at(3, 3, 2), 1.0f);
  EXPECT_FLOAT_EQ(picture->elements.at(3, 3, 3), -1.0f);
}

TEST_F(WatchedRenderTest, FramesWithAlphaAreShownOverBlack) {
  // Two elements have light 0.25 and alpha 0.5, so that their colours without alpha are 0.5. The
  // other two elements are empty.
  Image<uint16_t> straight(4, 1, 4);
  Image<float> light(4, 1, 3), alpha(4, 1);
  for (int x = 0; x < 2; ++x) {
    alpha.at(x, 0) = 0.5f;
    straight.at(x, 0, 3) = 32768;
    for (int c = 0; c < 3; ++c) light.at(x, 0, c) = 0.25f;
  }
  for (int x = 0; x < 4; ++x)
    for (int c = 0; c < 3; ++c) straight.at(x, 0, c) = 48195;  // sRGB of 0.5, even where alpha is 0
  ASSERT_TRUE(WriteImage(folder_ / "frame_0001.png", straight.view()));
  std::vector<ExrChannel> channels;
  for (int c = 0; c < 3; ++c) channels.push_back({{"RGB"[c]}, light.view(), c});
  channels.push_back({"A", alpha.view()});
  ASSERT_TRUE(WriteExr(folder_ / "frame_0002.exr", channels));
  for (const char* const name : {"frame_0001.png", "frame_0002.exr"}) {
    const auto picture = ReadGrowingPicture(folder_ / name, 100);
    ASSERT_TRUE(picture) << picture.error().message;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(picture->elements.at(0, 0, c), 0.25, 1e-4) << name;
      EXPECT_EQ(picture->elements.at(3, 0, c), 0) << name;
    }
    EXPECT_FALSE(picture->has_rays);
  }
}

}  // namespace
}  // namespace lf
