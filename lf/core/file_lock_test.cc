#include "lf/core/file_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

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

TEST(FileLock, NeedsAFolder) {
  EXPECT_EQ(FileLock::Take("/nowhere/lock").error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
