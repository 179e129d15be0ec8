// SPDX-License-Identifier: Apache-2.0
#include "lf/core/child_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "lf/core/file.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class ChildProcessTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("lf_child_process_test." + std::to_string(::getpid()) + "." +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

// Starts a shell script as a program that has an input.
std::unique_ptr<ChildProcess> Shell(const std::string& script) {
  ChildProcess::Options options;
  options.words = {"sh", "-c", script};
  options.has_input = true;
  return ChildProcess::Start(options).value();
}

std::optional<ProcessEnd> EndOf(ChildProcess& child) {
  for (int i = 0; i < 1000; ++i) {
    if (const auto end = child.Poll()) return end;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return std::nullopt;
}

std::string FailureOf(const Result<void>& result) {
  EXPECT_FALSE(result);
  if (result) return "";
  EXPECT_EQ(result.error().kind, ErrorKind::kOutput);
  return result.error().message;
}

TEST_F(ChildProcessTest, GetsAllBytesWeWrite) {
  auto child = Shell("cat > '" + (folder_ / "copy").string() + "'");
  std::vector<uint8_t> bytes(3'000'000);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(i * 7 + i / 1000);
  ASSERT_TRUE(child->Write(bytes, 30));
  ASSERT_TRUE(child->Finish(30));
  EXPECT_EQ(ReadFile(folder_ / "copy").value(), std::string(bytes.begin(), bytes.end()));
}

TEST_F(ChildProcessTest, AProgramThatDoesNotExistIsNamed) {
  for (const bool has_input : {true, false}) {
    ChildProcess::Options options;
    options.words = {"no-such-program-of-ours"};
    options.has_input = has_input;
    const auto child = ChildProcess::Start(options);
    ASSERT_FALSE(child);
    EXPECT_EQ(child.error().message,
              "no-such-program-of-ours: cannot be run: No such file or directory");
  }
}

// If a write raised SIGPIPE, the signal would kill this test.
TEST_F(ChildProcessTest, ALeavingProgramIsQuotedAndRaisesNoSignal) {
  auto child = Shell("echo 'no room left' >&2; exit 3");
  const std::vector<uint8_t> bytes(1'000'000);
  const std::string message = FailureOf(child->Write(bytes, 30));
  EXPECT_NE(message.find("exit code 3: no room left"), std::string::npos) << message;
  FailureOf(child->Write(bytes, 30));
  FailureOf(child->Finish(30));
}

TEST_F(ChildProcessTest, ManyComplaintsDoNotBlock) {
  auto child = Shell(
      "i=0; while [ $i -lt 3000 ]; do echo complaint number $i of many >&2; "
      "i=$((i+1)); done; cat > /dev/null; exit 1");
  ASSERT_TRUE(child->Write(std::vector<uint8_t>(500'000), 30));
  const std::string message = FailureOf(child->Finish(30));
  EXPECT_NE(message.find("complaint number 2999"), std::string::npos);
  EXPECT_LT(message.size(), 1000u);
}

TEST_F(ChildProcessTest, AStuckProgramIsEnded) {
  const auto begin = std::chrono::steady_clock::now();
  auto deaf = Shell("sleep 100");
  EXPECT_NE(FailureOf(deaf->Write(std::vector<uint8_t>(3'000'000), 0.2)).find("read nothing"),
            std::string::npos);
  auto endless = Shell("cat > /dev/null; sleep 100");
  EXPECT_NE(FailureOf(endless->Finish(0.2)).find("did not end"), std::string::npos);
  { const auto forgotten = Shell("sleep 100"); }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

// The time that send() waits is never 0, which would mean that it waits for ever.
TEST_F(ChildProcessTest, WithoutPatienceNothingWaits) {
  auto deaf = Shell("sleep 100");
  EXPECT_NE(FailureOf(deaf->Write(std::vector<uint8_t>(3'000'000), 0)).find("read nothing"),
            std::string::npos);
}

TEST_F(ChildProcessTest, FinishTellsAnEndThatPollHasReturned) {
  for (const int code : {0, 3}) {
    auto child = Shell("exit " + std::to_string(code));
    ASSERT_TRUE(EndOf(*child).has_value());
    EXPECT_EQ(child->Finish(30).has_value(), code == 0);
  }
}

TEST_F(ChildProcessTest, ADeathBySignalIsAFailure) {
  EXPECT_NE(FailureOf(Shell("kill -9 $$")->Finish(30)).find("signal 9"), std::string::npos);
}

TEST_F(ChildProcessTest, InheritsNoFilesAndNoIgnoredSignals) {
  const std::ofstream ours(folder_ / "ours");
  std::signal(SIGPIPE, SIG_IGN);
  auto child = Shell("grep '^SigIgn:.*0$' /proc/self/status > '" + (folder_ / "ignored").string() +
                     "'; ls -l /proc/self/fd > '" + (folder_ / "files").string() + "'");
  std::signal(SIGPIPE, SIG_DFL);
  ASSERT_TRUE(child->Finish(30));
  EXPECT_EQ(ReadFile(folder_ / "files").value().find((folder_ / "ours").string()),
            std::string::npos);
  EXPECT_NE(ReadFile(folder_ / "ignored").value(), "");
}

TEST_F(ChildProcessTest, IsToldFromOneThatDied) {
  const auto child = ChildProcess::Start({{"sleep", "60"}, {}});
  ASSERT_TRUE(child.has_value()) << child.error().message;
  EXPECT_FALSE((*child)->Poll().has_value());
  (*child)->Signal(SIGTERM);
  const auto end = EndOf(**child);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->signal, SIGTERM);
}

TEST_F(ChildProcessTest, RunsInTheFolderItIsGiven) {
  EXPECT_FALSE(ChildProcess::Start({{"true"}, "/no/such/folder"}).has_value());
  const auto child = ChildProcess::Start({{"sh", "-c", "test $PWD = /"}, "/"});
  ASSERT_TRUE(child.has_value());
  const auto end = EndOf(**child);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->exit_code, 0);
}

TEST_F(ChildProcessTest, KeepsOneFileOpenAndLeavesOurGroup) {
  const int kept = ::open((folder_ / "kept").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  const int output = ::open((folder_ / "files").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  ChildProcess::Options options;
  options.words = {"sh", "-c", "ls -l /proc/$$/fd; kill -KILL 0"};
  options.output = output;
  options.kept = kept;
  const auto child = ChildProcess::Start(options);
  ::close(kept);
  ::close(output);
  ASSERT_TRUE(child.has_value()) << child.error().message;
  const auto end = EndOf(**child);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->signal, SIGKILL);  // `kill -KILL 0` killed only the group of the program
  EXPECT_NE(ReadFile(folder_ / "files").value().find((folder_ / "kept").string()),
            std::string::npos);
}

// Starts `sleep 60` from a process that then ends. Returns the number of the sleeping process.
pid_t OrphanOf(bool has_input) {
  int numbers[2];
  EXPECT_EQ(::pipe2(numbers, O_CLOEXEC), 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    ChildProcess::Options options;
    options.words = {"sleep", "60"};
    options.has_input = has_input;
    const auto child = ChildProcess::Start(options);
    const pid_t number = child ? (*child)->process() : 0;
    ::_exit(::write(numbers[1], &number, sizeof(number)) == sizeof(number) ? 0 : 1);
  }
  ::close(numbers[1]);
  pid_t number = 0;
  EXPECT_EQ(::read(numbers[0], &number, sizeof(number)), static_cast<ssize_t>(sizeof(number)));
  ::close(numbers[0]);
  ::waitpid(parent, nullptr, 0);
  return number;
}

// Returns true if the process runs; false if it is dead, or a zombie that init has not yet reaped.
bool IsAlive(pid_t number) {
  const auto status = ReadFile("/proc/" + std::to_string(number) + "/status");
  return status && status->find("State:\tZ") == std::string::npos;
}

TEST_F(ChildProcessTest, EndsWithUsUnlessItHasAnInput) {
  const pid_t without = OrphanOf(false), with = OrphanOf(true);
  ASSERT_GT(without, 0);
  ASSERT_GT(with, 0);
  for (int i = 0; i < 1000 && IsAlive(without); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(IsAlive(without));
  EXPECT_TRUE(IsAlive(with));
  ::kill(with, SIGKILL);
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
  EXPECT_NE(slow.error().message.find("has not ended"), std::string::npos);
}

TEST(RunCommand, EndsOneThatPrintsWithoutEnd) {
  for (const char* command : {"exec yes", "exec yes >&2"}) {
    const Result<CommandAnswer> endless = RunCommand({"sh", "-c", command}, 60);
    ASSERT_FALSE(endless.has_value());
    EXPECT_EQ(endless.error().message, "sh: prints more than the 256 MiB that are expected");
  }
}

}  // namespace
}  // namespace lf
