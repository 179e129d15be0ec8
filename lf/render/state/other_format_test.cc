// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/other_format.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

#include "lf/core/log.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

std::string* g_warnings = nullptr;

class OtherFormatTest : public ::testing::Test {
 protected:
  OtherFormatTest() {
    fs::create_directories(folder_);
    g_warnings = &warnings_;
    SetLogReceiver([](LogLevel level, std::string_view text) {
      if (level == LogLevel::kWarning) *g_warnings += text;
    });
  }
  ~OtherFormatTest() override {
    SetLogReceiver(nullptr);
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  // Returns the warnings about frames 1, 2 and 12 if the folder has these files.
  std::string Warnings(std::initializer_list<const char*> names, FrameFormat format) {
    for (const char* name : names) std::ofstream(folder_ / name) << "x";
    WarnOfOtherFormat(folder_, frames_, format);
    return warnings_;
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("lf_other_format_" + std::to_string(::getpid()));
  const std::vector<FrameId> frames_ = {FrameId{1}, FrameId{2}, FrameId{12}};
  std::string warnings_;
};

TEST_F(OtherFormatTest, FramesOfTheSameFormatOrWithOtherNumbersAreNotWarnedOf) {
  EXPECT_EQ(Warnings({"frame_0001.png", "frame_0003.exr", "frame_2.exr", "contact_sheet.png"},
                     FrameFormat::kPng16),
            "");
}

TEST_F(OtherFormatTest, OneFrameIsNamed) {
  EXPECT_NE(Warnings({"frame_0002.exr"}, FrameFormat::kPng8)
                .find("frame_0002.exr has the name of a frame"),
            std::string::npos);
}

TEST_F(OtherFormatTest, FirstAndLastFrameAreNamed) {
  EXPECT_NE(Warnings({"frame_0001.png", "frame_0002.png", "frame_0012.png"}, FrameFormat::kExrFloat)
                .find("3 files, frame_0001.png to frame_0012.png, have names of frames"),
            std::string::npos);
}

}  // namespace
}  // namespace lf
