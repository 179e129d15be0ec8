// SPDX-License-Identifier: Apache-2.0
#include "lf/core/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace lf {
namespace {
namespace fs = std::filesystem;

class FileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("lf_file_test." + std::to_string(::getpid()) + "." +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  size_t FileCount() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }
  fs::path folder_;
};

TEST_F(FileTest, GivesBackWhatWasWritten) {
  const std::string bytes("light\0field", 11);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.bin", bytes));
  EXPECT_EQ(*ReadFile(folder_ / "a.bin"), bytes);
  EXPECT_EQ(FileCount(), 1u);
}

TEST_F(FileTest, ErrorsNameTheFileAndNotItsTemporaryName) {
  const fs::path file = folder_ / "none" / "file.txt";
  const Result<void> missing = WriteFileAtomically(file, "text");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("none does not exist"), std::string::npos);
  const Result<void> failed = WriteAtomically(folder_ / "file.txt", [](const fs::path& temporary) {
    return Result<void>(OutputError(temporary.string() + ": is odd"));
  });
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, (folder_ / "file.txt").string() + ": is odd");
}

TEST_F(FileTest, AFailedWriteLeavesTheOldFileAlone) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.txt", "old"));
  const Result<void> result =
      WriteAtomically(folder_ / "a.txt", [](const fs::path& temporary) -> Result<void> {
        std::ofstream(temporary) << "half of the new";
        return OutputError("disk full");
      });
  EXPECT_EQ(result.error().kind, ErrorKind::kOutput);
  EXPECT_EQ(*ReadFile(folder_ / "a.txt"), "old");
  EXPECT_EQ(FileCount(), 1u);
}

TEST_F(FileTest, AWriterThatThrowsLeavesNoTemporaryFile) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.txt", "old"));
  const auto write = [](const fs::path& temporary) -> Result<void> {
    std::ofstream(temporary) << "half of the new";
    throw std::bad_alloc();
  };
  EXPECT_THROW((void)WriteAtomically(folder_ / "a.txt", write), std::bad_alloc);
  EXPECT_EQ(*ReadFile(folder_ / "a.txt"), "old");
  EXPECT_EQ(FileCount(), 1u);
}

TEST(KindOfReadFailure, TellsTheMachineFromTheFile) {
  for (const int code : {EMFILE, ENFILE, ENOMEM, EAGAIN})
    EXPECT_EQ(KindOfReadFailure(code), ErrorKind::kOutput) << code;
  for (const int code : {EIO, ENOENT, EACCES})
    EXPECT_EQ(KindOfReadFailure(code), ErrorKind::kInput) << code;
  EXPECT_EQ(KindOfReadFailure(std::system_error(EAGAIN, std::system_category())),
            ErrorKind::kOutput);
  EXPECT_EQ(KindOfReadFailure(std::system_error(EIO, std::generic_category())), ErrorKind::kInput);
  EXPECT_EQ(KindOfReadFailure(std::ios_base::failure("cut")), ErrorKind::kInput);
  EXPECT_EQ(KindOfReadFailure(std::runtime_error("cut")), ErrorKind::kInput);
}

TEST_F(FileTest, TheTemporaryNameKeepsTheExtension) {
  ASSERT_TRUE(WriteAtomically(folder_ / "a.exr", [](const fs::path& temporary) -> Result<void> {
    EXPECT_EQ(temporary.extension(), ".exr");
    std::ofstream(temporary) << "x";
    return {};
  }));
}

TEST_F(FileTest, MissingAndHugeFilesAreErrorsThatNameThem) {
  EXPECT_NE(ReadFile(folder_ / "none").error().message.find("none"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "big", "123456789"));
  EXPECT_NE(ReadFile(folder_ / "big", 8).error().message.find("9 bytes"), std::string::npos);
  EXPECT_FALSE(ReadFile(folder_));
}

TEST_F(FileTest, APipeIsNeitherReadNorReplaced) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(ReadFile(pipe).error().kind, ErrorKind::kInput);
  EXPECT_EQ(WriteFileAtomically(pipe, "x").error().kind, ErrorKind::kOutput);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(FileTest, ALinkIsFollowed) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "real", "old"));
  fs::create_symlink(folder_ / "real", folder_ / "link");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "link", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(*ReadFile(folder_ / "real"), "new");
}

TEST_F(FileTest, PermissionsStay) {
  const auto path = folder_ / "private";
  ASSERT_TRUE(WriteFileAtomically(path, "old"));
  fs::permissions(path, fs::perms::owner_read);
  ASSERT_TRUE(WriteFileAtomically(path, "new"));
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read);
}

TEST_F(FileTest, AFolderIsCreatedWhileItsEmptyParentIsRemoved) {
  const fs::path parent = folder_ / "parent";
  std::atomic<bool> is_done = false;
  std::thread remover([&] {
    std::error_code ignored;
    while (!is_done) fs::remove(parent, ignored);
  });
  for (int i = 0; i < 200; ++i) {
    const Result<void> created = CreateFolder(parent / "child");
    EXPECT_TRUE(created) << created.error().message;
    std::error_code ignored;
    fs::remove(parent / "child", ignored);
  }
  is_done = true;
  remover.join();
}

TEST_F(FileTest, AFolderCannotReplaceAFile) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a", "x"));
  EXPECT_EQ(CreateFolder(folder_ / "a").error().kind, ErrorKind::kOutput);
  EXPECT_TRUE(CreateFolder(folder_ / "b" / "c"));
  EXPECT_EQ(WriteFileAtomically(folder_ / "none" / "a", "x").error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
