// SPDX-License-Identifier: Apache-2.0
// tests/programs/light_field_video_test.py compares the pixels of decoded frames.
#include "lf/import/video/video_frames.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "lf/core/child_process.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

class VideoFramesTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "video_framesXXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Makes a video of 20 frames, whose key frames are 4 frames apart.
  fs::path MakeVideo(const std::string& name) const {
    const fs::path video = folder_ / name;
    const Result<CommandAnswer> made = RunCommand(
        {"ffmpeg", "-v", "error", "-f", "lavfi", "-i", "testsrc=size=32x24:rate=10:duration=2",
         "-c:v", "libx264", "-g", "4", "-bf", "2", video.string()},
        60);
    EXPECT_TRUE(made && made->exit_code == 0);
    return video;
  }

  static size_t CountIn(const fs::path& folder) {
    size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      count += entry.is_regular_file();
    return count;
  }

  fs::path folder_;
};

TEST_F(VideoFramesTest, WantedFramesAreDecoded) {
  const fs::path video = MakeVideo("cam00.mp4");
  const Result<RecordedVideo> facts = ReadVideoFacts(video);
  ASSERT_TRUE(facts) << facts.error().message;
  ASSERT_EQ(facts->shown_s.size(), 20u);
  EXPECT_GT(facts->keys.size(), 3u);
  const fs::path decoded = folder_ / "100%d";  // no pattern
  const std::vector<WantedFrames> wanted = {{video, *facts, {0, 3, 4, 17, 19}}};
  const auto errors = DecodeFrames(wanted, decoded);
  ASSERT_TRUE(errors) << errors.error().message;
  EXPECT_FALSE(errors->at(0)) << errors->at(0)->message;
  for (const size_t frame : wanted[0].frames)
    EXPECT_TRUE(fs::exists(decoded / DecodedName(video, frame))) << frame;
  EXPECT_EQ(CountIn(decoded), 5u);
}

TEST_F(VideoFramesTest, ADamagedVideoIsAnErrorOfItsOwn) {
  const fs::path video = MakeVideo("cam00.mp4"), other = MakeVideo("cam01.mp4");
  const Result<RecordedVideo> facts = ReadVideoFacts(video);
  ASSERT_TRUE(facts);
  std::ofstream(other, std::ios::trunc) << "no video";
  const auto errors = DecodeFrames(
      std::vector<WantedFrames>{{other, *facts, {2}}, {video, *facts, {2}}}, folder_ / "frames");
  ASSERT_TRUE(errors) << errors.error().message;
  ASSERT_TRUE(errors->at(0));
  EXPECT_EQ(errors->at(0)->kind, ErrorKind::kInput);
  EXPECT_NE(errors->at(0)->message.find(other.string()), std::string::npos);
  EXPECT_FALSE(errors->at(1));
  EXPECT_EQ(CountIn(folder_ / "frames"), 1u);
}

TEST_F(VideoFramesTest, AChangedVideoHasOtherFiles) {
  const fs::path video = folder_ / "cam00.mp4";
  std::ofstream(video) << "a";
  const std::string before = DecodedName(video, 3);
  EXPECT_EQ(DecodedName(video, 3), before);
  EXPECT_TRUE(before.ends_with("/000003.png") && before.starts_with("cam00-")) << before;
  std::ofstream(video) << "ab";
  EXPECT_NE(DecodedName(video, 3), before);
}

TEST_F(VideoFramesTest, OldFilesAreRemovedDownToTheLimit) {
  const auto now = fs::file_time_type::clock::now();
  for (const int age_h : {1, 30, 40, 50}) {
    fs::create_directories(folder_ / std::to_string(age_h));
    const fs::path file = folder_ / std::to_string(age_h) / "000000.png";
    std::ofstream(file) << std::string(100, 'x');
    fs::last_write_time(file, now - std::chrono::hours(age_h));
  }
  RemoveOldFrames(folder_, 250);
  EXPECT_EQ(CountIn(folder_), 2u);
  EXPECT_FALSE(fs::exists(folder_ / "50"));
  EXPECT_FALSE(fs::exists(folder_ / "40"));
  RemoveOldFrames(folder_, 0);
  EXPECT_EQ(CountIn(folder_), 1u);
  EXPECT_TRUE(fs::exists(folder_ / "1" / "000000.png"));
}

}  // namespace
}  // namespace lf
