#include "lf/sequence/child_process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "lf/core/file.h"
#include "lf/imageio/test_folder.h"

namespace lf {
namespace {

class ChildProcessTest : public FolderTest {};

std::unique_ptr<ChildProcess> Shell(const std::string& script) {
  return ChildProcess::Start({"sh", "-c", script}).value();
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
  const auto child = ChildProcess::Start({"no-such-program-of-ours"});
  ASSERT_FALSE(child);
  EXPECT_NE(child.error().message.find("no-such-program-of-ours"), std::string::npos);
}

// If the write raised SIGPIPE, the test would be killed.
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
  EXPECT_NE(FailureOf(deaf->Write(std::vector<uint8_t>(3'000'000), 0.2)).find("taken in nothing"),
            std::string::npos);
  auto endless = Shell("cat > /dev/null; sleep 100");
  EXPECT_NE(FailureOf(endless->Finish(0.2)).find("did not end"), std::string::npos);
  { const auto forgotten = Shell("sleep 100"); }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
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

}  // namespace
}  // namespace lf
