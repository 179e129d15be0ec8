// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/video.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <csignal>
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
       {std::pair(29.97, "30000/1001"),    std::pair(23.976, "24000/1001"),
        std::pair(23.98, "24000/1001"),    std::pair(59.94, "60000/1001"),
        std::pair(29.97003, "30000/1001"), std::pair(24.97, "2497/100"),
        std::pair(23.97, "2397/100"),      std::pair(30.0, "30/1"),
        std::pair(12.5, "25/2"),           std::pair(24.0, "24/1"),
        std::pair(25.0, "25/1"),           std::pair(0.5, "1/2"),
        std::pair(101.0, "101/1"),         std::pair(119.88, "120000/1001"),
        std::pair(120.0, "120/1"),         std::pair(144.5, "289/2"),
        std::pair(239.76, "240000/1001"),  std::pair(240.0, "240/1"),
        std::pair(1000.0, "1000/1"),       std::pair(1e-3, "1/1000"),
        std::pair(1e6, "1000000/1")}) {
    auto video = VideoWriter::Open(path, 64, 32, fps).value();
    for (int frame = 0; frame < 6; ++frame) ASSERT_TRUE(video->Add(Patches(64, 32, frame)));
    const Result<void> closed = video->Close();
    ASSERT_TRUE(closed) << fps << ": " << closed.error().message;
    const std::string tags = Output(
        "ffprobe -v error -show_entries stream=r_frame_rate,avg_frame_rate,duration -of csv=p=0 '" +
        path.string() + "'");
    EXPECT_TRUE(tags.starts_with(fmt::format("{0},{0},", rate))) << fps << ": " << tags;
    const double duration_s = std::stod(tags.substr(tags.rfind(',') + 1));
    EXPECT_NEAR(duration_s, 6 / fps, 1e-6 + 1e-3 / fps) << fps;
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

// Limits the size of the files that this process and its children write.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_action_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit = {bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_action_);
  }

 private:
  rlimit old_ = {};
  void (*old_action_)(int);
};

TEST_F(VideoTest, AFileThatMayNotBecomeWholeIsAnErrorAndLeavesTheOldOne) {
  SKIP_WITHOUT_FFMPEG();
  const fs::path path = folder_ / "film.mp4";
  const auto write = [&] {
    auto video = VideoWriter::Open(path, 64, 32, 25).value();
    Result<void> result;
    for (int frame = 0; frame < 20 && result; ++frame) result = video->Add(Patches(64, 32, frame));
    return result ? video->Close() : result;
  };
  ASSERT_TRUE(write());
  const std::string whole = ReadFile(path).value();
  // The limits cut the file in the pictures, where they end, in the index, and at the last byte.
  for (const size_t bytes :
       {whole.size() / 2, whole.size() - 1500, whole.size() - 300, whole.size() - 1}) {
    const FileSizeLimit limit(bytes);
    const Result<void> written = write();
    ASSERT_FALSE(written) << bytes << " of " << whole.size();
    EXPECT_EQ(written.error().kind, ErrorKind::kOutput);
    EXPECT_NE(written.error().message.find("File too large"), std::string::npos)
        << written.error().message;
    EXPECT_EQ(ReadFile(path).value(), whole);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  }
}

// The fake ffmpeg copies the file `given` instead of encoding, and reads with the true ffmpeg.
TEST_F(VideoTest, AFileThatIsCutAfterwardsIsNotTaken) {
  SKIP_WITHOUT_FFMPEG();
  const std::string tools = ::getenv("PATH");
  const fs::path whole = folder_ / "whole.mp4", path = folder_ / "film.mp4";
  auto video = VideoWriter::Open(whole, 64, 32, 25).value();
  for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(video->Add(Patches(64, 32, frame)));
  ASSERT_TRUE(video->Close());
  const std::string bytes = ReadFile(whole).value();
  FakeFfmpeg(
      fmt::format("case \"$*\" in *libx264*) cat > /dev/null; for last; do :; done\n"
                  "cp '{}' \"${{last#file:}}\";; *) PATH='{}'; exec ffmpeg \"$@\";; esac",
                  (folder_ / "given").string(), tools));
  const PathVariable variable(folder_.string() + ":" + tools);
  const auto close = [&](size_t size, int picture_count) {
    EXPECT_TRUE(WriteFileAtomically(folder_ / "given", bytes.substr(0, size)));
    auto cut = VideoWriter::Open(path, 64, 32, 25).value();
    for (int frame = 0; frame < picture_count; ++frame)
      EXPECT_TRUE(cut->Add(Patches(64, 32, frame)));
    return cut->Close();
  };
  for (const size_t size :
       {size_t{0}, size_t{40}, bytes.find("mdat") + 4, bytes.size() / 2, bytes.size() - 1})
    EXPECT_FALSE(close(size, 20)) << size;
  const Result<void> other_count = close(bytes.size(), 21);
  ASSERT_FALSE(other_count);
  EXPECT_NE(other_count.error().message.find("only 20 of its 21 pictures"), std::string::npos)
      << other_count.error().message;
  EXPECT_FALSE(fs::exists(path));
  EXPECT_TRUE(close(bytes.size(), 20));
  EXPECT_TRUE(fs::exists(path));
}

TEST_F(VideoTest, OnlyNamesOfMp4FilesAreTaken) {
  for (const char* name : {"film.mp4", "film.MP4", "a.gif.Mp4"}) {
    EXPECT_TRUE(IsVideoName(name)) << name;
    EXPECT_TRUE(CheckVideoTarget(folder_ / name)) << name;
  }
  for (const char* name :
       {"film", "mp4", ".mp4", "film.gif", "film.webm", "film.mov", "film.mp4 "}) {
    EXPECT_FALSE(IsVideoName(name)) << name;
    const Result<void> checked = CheckVideoTarget(folder_ / name);
    ASSERT_FALSE(checked) << name;
    EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
    EXPECT_NE(checked.error().message.find("ends in .mp4"), std::string::npos);
  }
}

TEST_F(VideoTest, SizesAndRatesThatNoFilmHasAreErrors) {
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 1, 480, 10));
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 640, 480, 0));
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 640, 480, 1e-4));
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 640, 480, 2e6));
  EXPECT_FALSE(VideoWriter::Open(folder_ / "film.mp4", 640, 480, NAN));
}

}  // namespace
}  // namespace lf
