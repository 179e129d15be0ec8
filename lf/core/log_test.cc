// SPDX-License-Identifier: Apache-2.0
#include "lf/core/log.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

TEST(Log, MessagesAreOneLine) {
  EXPECT_EQ(OneLine("frame_0001.exr: übel ✓"), "frame_0001.exr: übel ✓");
  EXPECT_EQ(OneLine("a\nerror: b\r\x1b[2K\tc\x7f"), "a\\nerror: b\\x0d\\x1b[2K\\tc\\x7f");
  EXPECT_EQ(OneLine(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(OneLine(""), "");
}

// If a file name contains a line break, the text after it cannot pass for the last message.
TEST(Log, NamesCannotForgeTheLastLine) {
  testing::internal::CaptureStderr();
  LogMessage(LogLevel::kWarning, "a\nerror: b.png: no such file");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "warning: a\\nerror: b.png: no such file\n");
}

TEST(Log, AReceiverGetsMessagesInsteadOfStderr) {
  static std::string received;
  SetLogReceiver([](LogLevel level, std::string_view message) {
    received = fmt::format("{} {}", static_cast<int>(level), message);
  });
  testing::internal::CaptureStderr();
  LogMessage(LogLevel::kWarning, "a\nb");
  SetLogReceiver(nullptr);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(received, "2 a\\nb");
}

}  // namespace
}  // namespace lf
