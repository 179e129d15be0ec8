// How far a task of a job is: a small file, written by whoever runs it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

enum class TaskPhase {
  kWaiting,      // never begun
  kRunning,      // or its node has died
  kInterrupted,  // goes on with its checkpoint when it is begun again
  kDone,
  kFailed,  // and would again
};
const char* NameOf(TaskPhase phase);

struct TaskState {
  TaskPhase phase = TaskPhase::kWaiting;
  std::string node;          // where it was begun last
  int64_t process = 0;       // lfrenderer's number there
  uint32_t start_count = 0;  // how often lfrenderer was begun
  uint32_t crash_count = 0;  // how often it, or its node, died of something it cannot catch
  int exit_code = 0;         // kDone: 0 or 6; kFailed
  std::string message;       // why it is not running
  double begin_s = 0;        // since 1970, of the last start
  double end_s = 0;

  uint32_t restart_count() const { return start_count > 0 ? start_count - 1 : 0; }
};

std::string ToJson(const TaskState& state);
// kInput: no such text; the message calls it `name`.
Result<TaskState> ParseTaskState(std::string_view text, const std::string& name);

// A file that is not there is a task that was never begun. kInput: damaged.
Result<TaskState> ReadTaskState(const std::filesystem::path& path);
Result<void> WriteTaskState(const TaskState& state, const std::filesystem::path& path);

// What lfrenderer last wrote to a log (--progress json).
struct TaskProgress {
  uint64_t done = 0, total = 0;  // of `unit`; a start that goes on counts what is left
  std::string unit;
  double rate = 0;  // a second
  double seconds_left = 0;
  uint64_t image_done = 0, image_total = 0;  // LF images
  double quiet_s = 0;                        // since the log grew last
  std::string message;                       // the last line for people
};

// Any bytes: what is not understood is left out. Of the last start; done and total of the one
// before until it says its own.
TaskProgress ParseProgress(std::string_view log);
// Of a log's last lines; nothing where there is none.
TaskProgress ReadProgress(const std::filesystem::path& log);

// What it said to people since the last start.
std::vector<std::string> LinesOfLastStart(const std::filesystem::path& log);

// The line that separates starts in a log.
inline constexpr std::string_view kLogStart = "-- ";

}  // namespace lf
