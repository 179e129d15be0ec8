// SPDX-License-Identifier: Apache-2.0
#include "lf/core/output_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace lf {
namespace {

namespace fs = std::filesystem;

class OutputFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("lf_outputs_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "a");
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path Written(const std::string& name) const {
    std::ofstream(folder_ / name) << name;
    return folder_ / name;
  }
  static std::string Refusal(std::vector<OutputFile> outputs,
                             const std::vector<fs::path>& inputs = {}) {
    const Result<void> checked = CheckOutputFiles(std::move(outputs), inputs);
    if (checked) return "";
    EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
    return checked.error().message;
  }
  fs::path folder_;
};

TEST_F(OutputFilesTest, TwoNamesOfOneFileAreRefused) {
  fs::create_directory_symlink(folder_ / "a", folder_ / "link");
  const std::vector<OutputFile> twice = {
      {folder_ / "a" / "x.exr", "a frame"},
      {folder_ / "link" / "." / "x.exr", "the video", "{video}"}};
  EXPECT_NE(Refusal(twice).find("x.exr: would be written as a frame and as the video: give another "
                                "{video}"),
            std::string::npos)
      << Refusal(twice);
  Written("a/x.exr");
  EXPECT_NE(Refusal(twice), "");
  const fs::path link = folder_ / "y.exr";
  fs::create_symlink(folder_ / "a" / "x.exr", link);
  EXPECT_NE(Refusal({folder_ / "a" / "x.exr", link}), "");
}

TEST_F(OutputFilesTest, DifferentFilesAreFree) {
  EXPECT_EQ(Refusal({folder_ / "x.exr", folder_ / "a" / "x.exr"}), "");
  // A hard link is a name of its own: the output replaces only this name.
  fs::create_hard_link(Written("x.exr"), folder_ / "y.exr");
  EXPECT_EQ(Refusal({folder_ / "x.exr", folder_ / "y.exr"}), "");
}

TEST_F(OutputFilesTest, InputsStay) {
  const fs::path input = Written("a/in.exr");
  EXPECT_EQ(Refusal({folder_ / "out.exr"}, {input}), "");
  EXPECT_EQ(Refusal({folder_ / "out.exr"}, {folder_ / "out.exr"}), "") << "there is no input";
  EXPECT_NE(Refusal({folder_ / "a" / ".." / "a" / "in.exr"}, {input}).find("is an input file"),
            std::string::npos);
  fs::create_hard_link(input, folder_ / "out.exr");
  EXPECT_NE(Refusal({folder_ / "out.exr"}, {input}), "");
}

TEST_F(OutputFilesTest, FoldersHoldWhatIsInThem) {
  fs::create_directory_symlink(folder_ / "a", folder_ / "link");
  EXPECT_TRUE(LiesIn(folder_ / "link" / "b" / "c", folder_ / "a"));
  EXPECT_TRUE(LiesIn(folder_ / "a", folder_ / "a"));
  EXPECT_FALSE(LiesIn(folder_ / "ab", folder_ / "a"));
  EXPECT_FALSE(LiesIn(folder_ / "a" / ".." / "b", folder_ / "a"));
}

TEST_F(OutputFilesTest, LocksKeepOthersOutAndGo) {
  const std::vector<fs::path> outputs = {folder_ / "x.exr", folder_ / "y.ply"};
  {
    const auto first = LockOutputs(outputs);
    ASSERT_TRUE(first);
    EXPECT_FALSE(LockOutputs({folder_ / "z.png", folder_ / "y.ply"}));
    EXPECT_TRUE(LockOutputs({folder_ / "y.ply"})) << "one file is written in one step";
    const auto folder = LockOutputFolder(folder_ / "new");
    ASSERT_TRUE(folder);
    EXPECT_FALSE(LockOutputFolder(folder_ / "new"));
  }
  EXPECT_TRUE(LockOutputs(outputs));
  EXPECT_TRUE(fs::is_empty(folder_ / "new"));
}

}  // namespace
}  // namespace lf
