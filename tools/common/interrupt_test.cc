// SPDX-License-Identifier: Apache-2.0
#include "tools/common/interrupt.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace lf {
namespace {

// Receives a signal and works on for a time, without a look at any flag. Ends the process with code
// 0 if nothing else has ended it.
[[noreturn]] void WorkOn(std::chrono::milliseconds time) {
  ::raise(SIGTERM);
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ::_exit(0);
}

// Opening a light field has an EndsSoon of its own.
TEST(Interrupts, EndAProgramThatWorksOnAfterItHasOpenedALightField) {
  EXPECT_EXIT(
      {
        CatchInterrupts();
        { const EndsSoon until_open; }
        WorkOn(std::chrono::seconds(30));
      },
      testing::ExitedWithCode(5), "error: interrupted");
}

TEST(Interrupts, LeaveAJobTheTimeThatItNeeds) {
  EXPECT_EXIT(
      {
        CatchInterruptsOfJob();
        { const EndsSoon until_open; }
        WorkOn(std::chrono::milliseconds(2500));
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace lf
