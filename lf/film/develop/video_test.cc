// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/video.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

// Sets PATH, where programs are looked up, so that tests can run their own programs.
class PathVariable {
 public:
  explicit PathVariable(const std::string& path) : old_(::getenv("PATH")) {
    ::setenv("PATH", path.c_str(), 1);
  }
  ~PathVariable() { ::setenv("PATH", old_.c_str(), 1); }

 private:
  const std::string old_;
};

class VideoTest : public FolderTest {
 protected:
  // Returns the output of a shell command.
  std::string Output(const std::string& command) const {
    const fs::path file = folder_.string() + ".out";
    EXPECT_EQ(std::system((command + " > '" + file.string() + "' 2>&1").c_str()), 0) << command;
    const std::string output = ReadFile(file).value();
    fs::remove(file);
    return output;
  }
  // Puts a script with the name ffmpeg into the folder.
  void FakeFfmpeg(const std::string& script) const {
    ASSERT_TRUE(WriteFileAtomically(folder_ / "ffmpeg", "#!/bin/sh\n" + script));
    fs::permissions(folder_ / "ffmpeg", fs::perms::owner_all);
  }
};

#define SKIP_WITHOUT_FFMPEG() \
  if (const auto tool = CheckVideoTool(); !tool) GTEST_SKIP() << tool.error().message

constexpr std::array<std::array<uint8_t, 3>, 8> kPatches = {{{255, 0, 0},
                                                             {0, 255, 0},
                                                             {0, 0, 255},
                                                             {128, 128, 128},
                                                             {255, 255, 255},
                                                             {0, 0, 0},
                                                             {200, 120, 60},
                                                             {30, 90, 160}}};

// Returns a picture of vertical stripes, 32 pixels wide, in the colours kPatches. `shift` is the
// index of the first colour.
Image<uint8_t> Patches(int width, int height, int shift) {
  Image<uint8_t> picture(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) picture.at(x, y, c) = kPatches[(x / 32 + shift) % 8][c];
  return picture;
}

TEST_F(VideoTest, ColoursAndOrderOfFramesSurvive) {
  SKIP_WITHOUT_FFMPEG();
  const fs::path path = folder_ / "film.mp4";
  auto video = VideoWriter::Open(path, 256, 32, 25).value();
  for (int frame = 0; frame < 5; ++frame) ASSERT_TRUE(video->Add(Patches(256, 32, frame)));
  EXPECT_FALSE(fs::exists(path));
  ASSERT_TRUE(video->Close());

  const std::string raw = Output("ffmpeg -v error -i '" + path.string() +
                                 "' -vf scale=in_color_matrix=bt709:in_range=tv:flags=accurate_rnd"
                                 "+full_chroma_int,format=rgb24 -f rawvideo -");
  ASSERT_EQ(raw.size(), 5u * 256 * 32 * 3);
  for (int frame = 0; frame < 5; ++frame)
    for (int patch = 0; patch < 8; ++patch)
      for (int c = 0; c < 3; ++c) {
        const size_t at = ((static_cast<size_t>(frame) * 32 + 16) * 256 + patch * 32 + 16) * 3 + c;
        EXPECT_NEAR(static_cast<uint8_t>(raw[at]), kPatches[(patch + frame) % 8][c], 4)
            << "frame " << frame << " patch " << patch << " channel " << c;
      }
}

TEST_F(VideoTest, TagsNameTheMatrixThatWasUsed) {
  SKIP_WITHOUT_FFMPEG();
  const fs::path path = folder_ / "film.mp4";
  auto video = VideoWriter::Open(path, 64, 32, 30000.0 / 1001).value();
  for (int frame = 0; frame < 3; ++frame) ASSERT_TRUE(video->Add(Patches(64, 32, 0)));
  ASSERT_TRUE(video->Close());
  const std::string tags = Output(
      "ffprobe -v error -show_entries stream=codec_name,pix_fmt,color_range,color_space,"
      "color_transfer,color_primaries,r_frame_rate,nb_frames -of default=nw=1 '" +
      path.string() + "'");
  for (const char* tag :
       {"codec_name=h264", "pix_fmt=yuv420p", "color_range=tv", "color_space=bt709",
        "color_transfer=bt709", "color_primaries=bt709", "r_frame_rate=30000/1001", "nb_frames=3"})
    EXPECT_NE(tags.find(tag), std::string::npos) << tag << " in\n" << tags;
  const std::string bytes = ReadFile(path).value();
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "players must wait for the whole file";
}

TEST_F(VideoTest, RoundedRatesOfTelevisionBecomeExact) {
  SKIP_WITHOUT_FFMPEG();
  const fs::path path = folder_ / "film.mp4";
  for (const auto& [fps, rate] :
       {std::pair(29.97, "30000/1001"), std::pair(23.976, "24000/1001"),
        std::pair(23.98, "24000/1001"), std::pair(59.94, "60000/1001"),
        std::pair(29.97003, "30000/1001"), std::pair(24.97, "2497/100"),
        std::pair(23.97, "2397/100"), std::pair(30.0, "30/1"), std::pair(12.5, "25/2")}) {
    auto video = VideoWriter::Open(path, 64, 32, fps).value();
    ASSERT_TRUE(video->Add(Patches(64, 32, 0)));
    ASSERT_TRUE(video->Close());
    EXPECT_EQ(Output("ffprobe -v error -show_entries stream=r_frame_rate -of csv=p=0 '" +
                     path.string() + "'"),
              std::string(rate) + "\n")
        << fps;
  }
}

TEST_F(VideoTest, OddSizesLoseAColumnAndARow) {
  SKIP_WITHOUT_FFMPEG();
  const fs::path path = folder_ / "a%d film's.mp4";
  auto video = VideoWriter::Open(path, 65, 33, 10).value();
  ASSERT_TRUE(video->Add(Patches(65, 33, 0)));
  ASSERT_TRUE(video->Close());
  fs::rename(path, folder_ / "film.mp4");
  EXPECT_EQ(Output("ffprobe -v error -show_entries stream=width,height -of csv=p=0 '" +
                   (folder_ / "film.mp4").string() + "'"),
            "64,32\n");
}

TEST_F(VideoTest, AnUnfinishedFilmLeavesNothing) {
  SKIP_WITHOUT_FFMPEG();
  {
    auto video = VideoWriter::Open(folder_ / "film.mp4", 64, 32, 10).value();
    ASSERT_TRUE(video->Add(Patches(64, 32, 0)));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  {
    auto video = VideoWriter::Open(folder_ / "film.mp4", 64, 32, 10).value();
    EXPECT_EQ(video->Close().error().kind, ErrorKind::kOutput);  // no picture was added
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(VideoTest, AMissingFolderIsAnErrorInFfmpegsWords) {
  SKIP_WITHOUT_FFMPEG();
  auto video = VideoWriter::Open(folder_ / "none" / "film.mp4", 64, 32, 10).value();
  Result<void> result;
  for (int frame = 0; frame < 3 && result; ++frame) result = video->Add(Patches(64, 32, 0));
  if (result) result = video->Close();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kOutput);
  EXPECT_NE(result.error().message.find("No such file"), std::string::npos)
      << result.error().message;
}

TEST_F(VideoTest, WithoutFfmpegTheAdviceIsToInstallIt) {
  const PathVariable path(folder_.string());
  const Result<void> tool = CheckVideoTool();
  ASSERT_FALSE(tool);
  EXPECT_EQ(tool.error().kind, ErrorKind::kOutput);
  EXPECT_NE(tool.error().message.find("apt-get install ffmpeg"), std::string::npos);
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 64, 32, 10));
}

TEST_F(VideoTest, AnFfmpegWithoutTheEncoderIsNoticedAtTheStart) {
  FakeFfmpeg("echo \"Unknown encoder 'libx264'\" >&2; exit 1");
  const PathVariable path(folder_.string() + ":" + ::getenv("PATH"));
  const Result<void> tool = CheckVideoTool();
  ASSERT_FALSE(tool);
  EXPECT_NE(tool.error().message.find("Unknown encoder"), std::string::npos);
}

TEST_F(VideoTest, AnFfmpegThatDiesMidwayIsQuoted) {
  FakeFfmpeg("head -c 1000 > /dev/null; echo 'No space left on device' >&2; exit 1");
  const PathVariable path(folder_.string() + ":" + ::getenv("PATH"));
  auto video = VideoWriter::Open(folder_ / "film.mp4", 640, 480, 10).value();
  Result<void> result;
  for (int frame = 0; frame < 20 && result; ++frame) result = video->Add(Patches(640, 480, 0));
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("No space left on device"), std::string::npos);
  EXPECT_NE(result.error().message.find("film.mp4"), std::string::npos);
}

TEST_F(VideoTest, AStuckFfmpegIsGivenUp) {
  FakeFfmpeg("sleep 100");
  const PathVariable path(folder_.string() + ":" + ::getenv("PATH"));
  auto video = VideoWriter::Open(folder_ / "film.mp4", 640, 480, 10, 0.2).value();
  Result<void> result;
  for (int frame = 0; frame < 20 && result; ++frame) result = video->Add(Patches(640, 480, 0));
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("was killed"), std::string::npos);
}

TEST_F(VideoTest, SizesAndRatesThatNoFilmHasAreErrors) {
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 1, 480, 10));
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 640, 480, 0));
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 640, 480, NAN));
}

}  // namespace
}  // namespace lf
