// SPDX-License-Identifier: Apache-2.0
#include "lf/core/process_identity.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace lf {
namespace {

TEST(ProcessIdentity, IsReadAsItWasWritten) {
  const ProcessIdentity self = IdentityOf(::getpid());
  EXPECT_GT(self.start, 0U);
  EXPECT_TRUE(TextOf(self).starts_with(std::to_string(::getpid()) + " "));
  EXPECT_EQ(ReadIdentity(TextOf(self)), self);
  const ProcessIdentity unknown = {.process = 7, .start = 0, .system = "", .host = ""};
  EXPECT_EQ(ReadIdentity(TextOf(unknown)), unknown);
  for (const char* text : {"", "7", "7 1 system", "x 1 system host", "0 1 system host",
                           "7 -1 system host", "7 1 system host more"})
    EXPECT_FALSE(ReadIdentity(text)) << text;
}

TEST(ProcessIdentity, AProcessLivesUntilItEnds) {
  const pid_t child = ::fork();
  if (child == 0) {
    while (true) ::pause();
  }
  const ProcessIdentity identity = IdentityOf(child);
  EXPECT_EQ(LifeOf(identity), ProcessLife::kLives);
  ::kill(child, SIGKILL);
  siginfo_t info{};
  ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT), 0);
  EXPECT_EQ(LifeOf(identity), ProcessLife::kEnded) << "has ended, but was not waited for";
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(LifeOf(identity), ProcessLife::kEnded);
}

TEST(ProcessIdentity, ANumberThatWasGivenAnewIsAnotherProcess) {
  ProcessIdentity before = IdentityOf(::getpid());
  --before.start;
  EXPECT_EQ(LifeOf(before), ProcessLife::kEnded);
}

TEST(ProcessIdentity, NothingIsKnownOfOtherMachines) {
  ProcessIdentity other = IdentityOf(::getpid());
  other.system = "another";
  EXPECT_EQ(LifeOf(other), ProcessLife::kUnknown);
  other.system = "";
  EXPECT_EQ(LifeOf(other), ProcessLife::kUnknown);
}

}  // namespace
}  // namespace lf
