// SPDX-License-Identifier: Apache-2.0
#include "lf/core/temporary_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "lf/core/file.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class TemporaryFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("lf_temporary_test." + std::to_string(::getpid()) + "." +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Creates the temporary file that a process of this host with the number `process` would write
  // for `file`.
  fs::path Leave(const std::string& file, pid_t process) const {
    std::string name = TemporaryPath(folder_ / file).filename().string();
    const std::string own = fmt::format(".{}-", ::getpid());
    name.replace(name.find(own), own.size(), fmt::format(".{}-", process));
    std::ofstream(folder_ / name) << "half";
    return folder_ / name;
  }
  // Returns the number of a process that has ended.
  static pid_t DeadProcess() {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    ::waitpid(child, nullptr, 0);
    return child;
  }
  fs::path folder_;
};

TEST_F(TemporaryFileTest, TheNameKeepsFolderAndExtension) {
  const fs::path path = TemporaryPath("film/frame.one.exr");
  EXPECT_EQ(path.parent_path(), "film");
  EXPECT_EQ(path.extension(), ".exr");
  EXPECT_TRUE(path.filename().string().starts_with(".frame.one." + std::to_string(::getpid())));
  EXPECT_TRUE(IsTemporaryName(path.filename()));
  EXPECT_TRUE(IsTemporaryName(TemporaryPath("none").filename()));
}

TEST_F(TemporaryFileTest, NamesOfPeopleAreNotTemporary) {
  for (const char* const name :
       {"frame.exr", ".hidden", ".hidden.tmp", ".hidden.tmp.txt", ".a.12.tmp.exr", ".a.12-.tmp.exr",
        ".a.x-0123abcd.tmp.exr", ".a.12-0123abcg.tmp.exr", ".a.12-0123abcd.tmp.e.exr",
        "a.12-0123abcd.tmp.exr", ".12-0123abcd.tmp.exr", ".a.-12-0123abcd.tmp", ".tmp", "", "."})
    EXPECT_FALSE(IsTemporaryName(name)) << name;
  EXPECT_TRUE(IsTemporaryName(".a.12-0123abcd.tmp.exr"));
}

TEST_F(TemporaryFileTest, LeftoversOfDeadProcessesAreRemovedByTheNextWriter) {
  const pid_t dead = DeadProcess();
  const fs::path left = Leave("a.exr", dead);
  const fs::path other_format = Leave("a.png", dead), other_name = Leave("b.a.exr", dead);
  const fs::path alive = Leave("a.exr", 1);
  const fs::path elsewhere = folder_ / (".a." + std::to_string(dead) + "-00000000.tmp.exr");
  std::ofstream(elsewhere) << "half";
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.exr", "whole"));
  EXPECT_FALSE(fs::exists(left));
  for (const fs::path& kept : {other_format, other_name, alive, elsewhere})
    EXPECT_TRUE(fs::exists(kept)) << kept;
  ASSERT_TRUE(WriteFileAtomically(folder_ / "b.a.exr", "whole"));
  EXPECT_FALSE(fs::exists(other_name));
}

TEST_F(TemporaryFileTest, IsRemovedUnlessItIsKept) {
  fs::path path;
  {
    TemporaryFile file(folder_ / "a.txt");
    std::ofstream(file.path()) << "half";
    TemporaryFile moved = std::move(file);
    path = moved.path();
  }
  EXPECT_FALSE(fs::exists(path));
  TemporaryFile file(folder_ / "a.txt");
  std::ofstream(file.path()) << "whole";
  { TemporaryFile(std::move(file)).Keep(); }
  EXPECT_TRUE(fs::exists(path));
}

}  // namespace
}  // namespace lf
