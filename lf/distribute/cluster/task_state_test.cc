// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/task_state.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(TaskState, IsTheSameWhenWrittenAndRead) {
  TaskState state;
  state.phase = TaskPhase::kFailed;
  state.node = "n3";
  state.process = 1234;
  state.start_count = 3;
  state.crash_count = 2;
  state.exit_code = 4;
  state.message = "error: \"disk full\"";
  state.begin_s = 1.5e9;
  const Result<TaskState> again = ParseTaskState(ToJson(state), "state");
  ASSERT_TRUE(again.has_value()) << again.error().message;
  EXPECT_EQ(ToJson(*again), ToJson(state));
  EXPECT_EQ(again->restart_count(), 2u);
}

TEST(TaskState, OfAFileThatIsMissingWaits) {
  const Result<TaskState> state = ReadTaskState("/nowhere/package-0000.json");
  ASSERT_TRUE(state.has_value());
  EXPECT_EQ(state->phase, TaskPhase::kWaiting);
}

constexpr const char* kLine =
    R"({"unit":"px","done":30,"total":100,"rate":2.5,"seconds_left":28,"counts":{"LF image":[3,9]}})";

TEST(TaskProgress, IsTheLastLineOfTheLog) {
  const TaskProgress progress =
      ParseProgress(std::string("-- start 1\nwarning: first\n") +
                    R"({"unit":"px","done":10,"total":100,"rate":1,"seconds_left":90})" + "\n" +
                    kLine + "\na checkpoint\n{\"unit\":\"px\",\"do");
  EXPECT_EQ(progress.done, 30u);
  EXPECT_EQ(progress.rate, 2.5);
  EXPECT_EQ(progress.image_done, 3u);
  EXPECT_EQ(progress.image_total, 9u);
  EXPECT_EQ(progress.message, "a checkpoint");
}

TEST(TaskProgress, AStartBeginsWhereTheOneBeforeEnded) {
  const TaskProgress progress = ParseProgress(std::string(kLine) + "\nkilled\n-- start 2\n");
  EXPECT_EQ(progress.done, 30u);
  EXPECT_EQ(progress.rate, 0);
  EXPECT_EQ(progress.message, "");
}

}  // namespace
}  // namespace lf
