// SPDX-License-Identifier: Apache-2.0
#include "lf/core/file_lock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace lf {
namespace {

std::filesystem::path LockPath(const char* name) {
  return std::filesystem::temp_directory_path() /
         ("lf_lock_" + std::to_string(::getpid()) + "_" + name);
}

TEST(FileLock, OneAtATimeAndTheNextWhenItIsLetGo) {
  const auto path = LockPath("a");
  {
    Result<FileLock> first = FileLock::Take(path);
    ASSERT_TRUE(first) << first.error().message;
    const Result<FileLock> second = FileLock::Take(path);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, ErrorKind::kOutput);
    EXPECT_NE(second.error().message.find("process " + std::to_string(::getpid())),
              std::string::npos);
  }
  EXPECT_FALSE(FileLock::IsHeld(path));
  Result<FileLock> third = FileLock::Take(path);
  ASSERT_TRUE(third);
  EXPECT_TRUE(FileLock::IsHeld(path));
  third->Remove();
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(FileLock::IsHeld(path));
}

TEST(FileLock, IsRemovedInTheEndIfThatIsAskedFor) {
  const auto path = LockPath("c");
  {
    Result<FileLock> lock = FileLock::Take(path);
    ASSERT_TRUE(lock);
    lock->RemoveInTheEnd();
    const FileLock moved = *std::move(lock);
    EXPECT_TRUE(FileLock::IsHeld(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(FileLock, DiesWithItsProcess) {
  const auto path = LockPath("b");
  int pipe_ends[2];
  ASSERT_EQ(::pipe(pipe_ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    Result<FileLock> lock = FileLock::Take(path);
    (void)!::write(pipe_ends[1], lock ? "y" : "n", 1);
    while (true) ::pause();
  }
  char answer = 0;
  ASSERT_EQ(::read(pipe_ends[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y');
  EXPECT_FALSE(FileLock::Take(path));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  Result<FileLock> lock = FileLock::Take(path);
  ASSERT_TRUE(lock);
  lock->Remove();
}

// Locks an empty file, like a program that has not written its process number yet.
class LockedEmptyFile {
 public:
  LockedEmptyFile(const std::filesystem::path& path, int operation)
      : fd_(::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    EXPECT_EQ(::flock(fd_, operation), 0);
  }
  ~LockedEmptyFile() { Close(); }
  void Close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }
  void Write(std::string_view text) {
    EXPECT_EQ(::write(fd_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

 private:
  int fd_;
};

constexpr std::chrono::milliseconds kMoment{20};

TEST(FileLock, WaitsForTheNumberOfItsOwner) {
  const auto path = LockPath("d");
  LockedEmptyFile owner(path, LOCK_EX);
  std::jthread writes([&] {
    std::this_thread::sleep_for(kMoment);
    owner.Write("123\n");
  });
  const Result<FileLock> lock = FileLock::Take(path);
  ASSERT_FALSE(lock);
  EXPECT_NE(lock.error().message.find("another program (process 123) works"), std::string::npos)
      << lock.error().message;
  std::filesystem::remove(path);
}

TEST(FileLock, IsTakenAfterAMomentInWhichSomebodyLooked) {
  const auto path = LockPath("e");
  LockedEmptyFile looks(path, LOCK_SH);
  std::jthread ends([&] {
    std::this_thread::sleep_for(kMoment);
    looks.Close();
  });
  Result<FileLock> lock = FileLock::Take(path);
  ASSERT_TRUE(lock) << lock.error().message;
  lock->Remove();
}

TEST(FileLock, AnOwnerWithoutANumberLocksToo) {
  const auto path = LockPath("f");
  const LockedEmptyFile owner(path, LOCK_EX);
  const Result<FileLock> lock = FileLock::Take(path);
  ASSERT_FALSE(lock);
  EXPECT_NE(lock.error().message.find("another program works"), std::string::npos)
      << lock.error().message;
  std::filesystem::remove(path);
}

TEST(FileLock, IsTakenInAFolderThatOthersRemove) {
  const auto folder = LockPath("g");
  for (int i = 0; i < 20; ++i) {
    std::atomic<bool> is_taken = false;
    std::jthread removes([&] {
      std::error_code ignored;
      for (int left = 3; left > 0 && !is_taken;)
        if (std::filesystem::remove(folder, ignored)) --left;
    });
    Result<FileLock> lock = FileLock::TakeInFolder(folder);
    is_taken = true;
    ASSERT_TRUE(lock) << lock.error().message;
    EXPECT_TRUE(FileLock::IsHeld(folder / "lock"));
    lock->Remove();
  }
  std::filesystem::remove(folder);
}

// A limit of the file size stands for a full disk.
TEST(FileLock, LeavesNoFileOnAFullDisk) {
  const auto path = LockPath("h");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  rlimit none = before;
  none.rlim_cur = 0;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &none), 0);
  const Result<FileLock> lock = FileLock::Take(path);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ::signal(SIGXFSZ, handler);
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error().kind, ErrorKind::kOutput);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(FileLock, NeedsAFolder) {
  EXPECT_EQ(FileLock::Take("/nowhere/lock").error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
