// SPDX-License-Identifier: Apache-2.0
#include "lf/core/lock_claims.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <optional>
#include <thread>
#include <vector>

#include "lf/core/process_identity.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

constexpr ClaimTimes kQuick = {.refresh_s = 0.05, .stale_s = 5, .watch_s = 0.4};

class LockClaims : public ::testing::Test {
 protected:
  LockClaims() { fs::create_directories(folder_); }
  ~LockClaims() override { fs::remove_all(folder_); }

  // Writes the claim of a process, which was refreshed `age_s` ago.
  fs::path Write(const std::string& name, const ProcessIdentity& identity, double age_s) const {
    fs::create_directories(claims_);
    std::ofstream(claims_ / name) << TextOf(identity) << "\n";
    Age(claims_ / name, age_s);
    return claims_ / name;
  }
  static void Age(const fs::path& file, double age_s) {
    const auto age = std::chrono::milliseconds(static_cast<int64_t>(1000 * age_s));
    fs::last_write_time(file, fs::file_time_type::clock::now() - age);
  }
  static ProcessIdentity OfAnotherMachine() {
    return {.process = 4711, .start = 5, .system = "another", .host = "node07"};
  }
  static ProcessIdentity Dead() {
    ProcessIdentity identity = IdentityOf(::getpid());
    --identity.start;
    return identity;
  }

  const fs::path folder_ = fs::temp_directory_path() / fmt::format("lf_claims_{}", ::getpid());
  const fs::path path_ = folder_ / "lock";
  const fs::path claims_ = folder_ / "lock.claims";
};

TEST_F(LockClaims, OneAtATimeAndTheNextWhenItIsLetGo) {
  auto first = LockClaim::Take(path_);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_TRUE(LockClaim::IsAny(path_));
  EXPECT_FALSE(LockClaim::CheckNone(path_));
  const auto second = LockClaim::Take(path_);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::kOutput);
  EXPECT_NE(second.error().message.find(fmt::format("(process {} on ", ::getpid())),
            std::string::npos)
      << second.error().message;
  first->reset();
  EXPECT_FALSE(fs::exists(claims_));
  EXPECT_FALSE(LockClaim::IsAny(path_));
  EXPECT_TRUE(LockClaim::CheckNone(path_));
  EXPECT_TRUE(LockClaim::Take(path_));
}

TEST_F(LockClaims, AClaimOfADeadProcessIsTakenOverAtOnce) {
  const fs::path dead = Write("dead", Dead(), 0);
  EXPECT_FALSE(LockClaim::IsAny(path_));
  const auto claim = LockClaim::Take(path_);
  ASSERT_TRUE(claim) << claim.error().message;
  EXPECT_FALSE(fs::exists(dead));
}

TEST_F(LockClaims, AYoungClaimOfAnotherMachineIsRespected) {
  const fs::path other = Write("other", OfAnotherMachine(), 2);
  EXPECT_TRUE(LockClaim::IsAny(path_, kQuick));
  const auto claim = LockClaim::Take(path_, kQuick);
  ASSERT_FALSE(claim);
  for (const std::string& words : {std::string("process 4711 on node07"), std::string("last seen "),
                                   std::string("is 5 s old"), other.string()})
    EXPECT_NE(claim.error().message.find(words), std::string::npos) << claim.error().message;
  EXPECT_TRUE(fs::exists(other));
}

TEST_F(LockClaims, AnOldClaimOfAnotherMachineIsTakenOver) {
  const fs::path other = Write("other", OfAnotherMachine(), 6);
  EXPECT_FALSE(LockClaim::IsAny(path_, kQuick));
  const auto claim = LockClaim::Take(path_, kQuick);
  ASSERT_TRUE(claim) << claim.error().message;
  EXPECT_FALSE(fs::exists(other));
}

TEST_F(LockClaims, AnOldClaimThatIsRefreshedLives) {
  const fs::path other = Write("other", OfAnotherMachine(), 6);
  std::jthread refreshes([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    Age(other, 5.5);  // the clock of that machine is slow
  });
  EXPECT_FALSE(LockClaim::Take(path_, kQuick));
  EXPECT_TRUE(fs::exists(other));
}

TEST_F(LockClaims, AnEmptyClaimIsThatOfAnUnknownProcess) {
  fs::create_directories(claims_);
  const fs::path empty = claims_ / "empty";
  std::ofstream(empty).close();
  EXPECT_FALSE(LockClaim::Take(path_, kQuick));
  Age(empty, 6);
  EXPECT_TRUE(LockClaim::Take(path_, kQuick));
}

TEST_F(LockClaims, AClaimIsRefreshedWhileItIsHeld) {
  const auto claim = LockClaim::Take(path_, kQuick);
  ASSERT_TRUE(claim);
  const fs::path file = fs::directory_iterator(claims_)->path();
  Age(file, 100);
  const auto before = fs::last_write_time(file);
  for (int i = 0; i < 500 && fs::last_write_time(file) == before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_GT(fs::last_write_time(file), before);
}

TEST_F(LockClaims, IsSharedWithAChild) {
  const pid_t child = ::fork();
  if (child == 0) {
    while (true) ::pause();
  }
  const pid_t owner = ::fork();
  if (owner == 0) {
    auto claim = LockClaim::Take(path_);
    const bool is_shared = claim && (*claim)->ShareWith(child);
    ::_exit(is_shared ? 0 : 1);  // without releasing it
  }
  int status = 0;
  ASSERT_EQ(::waitpid(owner, &status, 0), owner);
  ASSERT_EQ(status, 0);
  EXPECT_FALSE(LockClaim::Take(path_)) << "the child lives";
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(LockClaim::Take(path_)) << "both have ended";
}

TEST_F(LockClaims, AProcessThatLosesItsClaimEndsAtOnce) {
  const pid_t owner = ::fork();
  if (owner == 0) {
    auto claim = LockClaim::Take(path_, kQuick);
    if (!claim) ::_exit(1);
    fs::remove_all(claims_);
    while (true) ::pause();
  }
  int status = 0;
  ASSERT_EQ(::waitpid(owner, &status, 0), owner);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 4);
}

// Many processes find the same dead claim at once, again and again. Each that gets the lock creates
// a file, which must not exist, and removes it.
TEST_F(LockClaims, NoTwoProcessesTakeOverADeadClaim) {
  constexpr int kProcesses = 6, kRounds = 25;
  std::vector<pid_t> children;
  for (int i = 0; i < kProcesses; ++i) {
    children.push_back(::fork());
    if (children.back() != 0) continue;
    const fs::path mark = folder_ / "mark";
    int taken = 0;
    for (int round = 0; round < kRounds; ++round) {
      auto claim = LockClaim::Take(path_, kQuick);
      if (!claim) continue;
      ++taken;
      const int fd = ::open(mark.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
      if (fd < 0) ::_exit(1);
      ::close(fd);
      Write(fmt::format("dead{}-{}", i, round), Dead(), 0);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (::unlink(mark.c_str()) != 0) ::_exit(2);
    }
    ::_exit(taken > 0 ? 0 : 3);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) != 1) << "two had the lock";
    EXPECT_NE(WEXITSTATUS(status), 2) << "two had the lock";
  }
}

TEST_F(LockClaims, NeedsAFolder) {
  const auto claim = LockClaim::Take("/nowhere/lock");
  ASSERT_FALSE(claim);
  EXPECT_EQ(claim.error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
