#include "lf/cluster/command.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

namespace lf {
namespace {

std::optional<CommandEnd> EndOf(Command& command) {
  for (int i = 0; i < 1000; ++i) {
    if (const auto end = command.Poll()) return end;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return std::nullopt;
}

TEST(RunCommand, GivesWhatItPrintsAndHowItEnds) {
  const Result<CommandAnswer> answer =
      RunCommand({"sh", "-c", "echo yes; echo no >&2; exit 7"}, 10);
  ASSERT_TRUE(answer.has_value()) << answer.error().message;
  EXPECT_EQ(answer->exit_code, 7);
  EXPECT_EQ(answer->output, "yes\n");
  EXPECT_EQ(answer->complaints, "no\n");
}

TEST(RunCommand, SaysWhyItCannot) {
  const Result<CommandAnswer> missing = RunCommand({"no-such-program-at-all"}, 10);
  ASSERT_FALSE(missing.has_value());
  EXPECT_NE(missing.error().message.find("No such file"), std::string::npos);
  const Result<CommandAnswer> slow = RunCommand({"sleep", "60"}, 0.05);
  ASSERT_FALSE(slow.has_value());
  EXPECT_NE(slow.error().message.find("has not answered"), std::string::npos);
}

TEST(RunCommand, EndsOneThatPrintsWithoutEnd) {
  for (const char* command : {"exec yes", "exec yes >&2"}) {
    const Result<CommandAnswer> endless = RunCommand({"sh", "-c", command}, 60);
    ASSERT_FALSE(endless.has_value());
    EXPECT_EQ(endless.error().message, "sh: prints more than 256 MiB");
  }
}

TEST(Command, IsToldFromOneThatDied) {
  const auto command = Command::Start({{"sleep", "60"}, {}});
  ASSERT_TRUE(command.has_value()) << command.error().message;
  EXPECT_FALSE((*command)->Poll().has_value());
  (*command)->Signal(SIGTERM);
  const auto end = EndOf(**command);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->signal, SIGTERM);
}

TEST(Command, RunsInTheFolderItIsGiven) {
  EXPECT_FALSE(Command::Start({{"true"}, "/no/such/folder"}).has_value());
  const auto command = Command::Start({{"sh", "-c", "test $PWD = /"}, "/"});
  ASSERT_TRUE(command.has_value());
  const auto end = EndOf(**command);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->exit_code, 0);
}

}  // namespace
}  // namespace lf
