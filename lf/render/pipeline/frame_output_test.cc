// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/frame_output.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

// A film of two frames, and a script that is run instead of ffmpeg.
class FilmFilesTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    film_ = {folder_, FrameFormat::kPng8, ColourSpace::kRec709, 32, 16, 25, nullptr};
    for (const FrameId frame : frames_) {
      const Image<uint8_t> picture = NoiseImage<uint8_t>(32, 16, 3);
      ASSERT_TRUE(WriteImage(FramePath(folder_, frame, film_.format), picture.view()));
    }
    ::setenv("PATH", (folder_.string() + ":" + path_before_).c_str(), 1);
  }
  void TearDown() override {
    ::setenv("PATH", path_before_.c_str(), 1);
    FolderTest::TearDown();
  }
  void FakeFfmpeg(const std::string& script) const {
    ASSERT_TRUE(WriteFileAtomically(folder_ / "ffmpeg", "#!/bin/sh\n" + script));
    fs::permissions(folder_ / "ffmpeg", fs::perms::owner_all);
  }

  FilmFiles film_;
  const std::vector<FrameId> frames_ = {FrameId{1}, FrameId{2}};

 private:
  const std::string path_before_ = ::getenv("PATH");
};

TEST_F(FilmFilesTest, AnEncoderThatFailsAtTheEndIsAnError) {
  FakeFfmpeg("cat > /dev/null; echo 'No space left on device' >&2; exit 1\n");
  const Result<void> written = film_.WriteVideo(frames_, folder_ / "film.mp4");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kOutput);
  EXPECT_NE(written.error().message.find("No space left on device"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "film.mp4"));
}

TEST_F(FilmFilesTest, AVideoGetsThePixelsOfAllFrames) {
  FakeFfmpeg(
      "case \"$*\" in *libx264*) for last; do :; done; cat > \"${last#file:}\";; "
      "*) echo frame=2;; esac\n");
  const Result<void> written = film_.WriteVideo(frames_, folder_ / "film.mp4");
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(fs::file_size(folder_ / "film.mp4"), 2u * 32 * 16 * 3);
}

}  // namespace
}  // namespace lf
