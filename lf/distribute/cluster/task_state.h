// The progress of a task of a job: a small file, written by the process that runs the task.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

enum class TaskPhase {
  kWaiting,      // never started
  kRunning,      // running, or its node has died
  kInterrupted,  // resumes from its checkpoint when it is started again
  kDone,
  kFailed,  // and would fail again
};
const char* NameOf(TaskPhase phase);

struct TaskState {
  TaskPhase phase = TaskPhase::kWaiting;
  std::string node;          // where it was started last
  int64_t process = 0;       // process id of lfrenderer on the node
  uint32_t start_count = 0;  // starts of lfrenderer
  uint32_t crash_count = 0;  // crashes of lfrenderer or its node
  int exit_code = 0;         // if kDone, 0 or 6
  std::string message;       // why it is not running
  double begin_s = 0;        // of the last start, in seconds since 1970
  double end_s = 0;

  uint32_t restart_count() const { return start_count > 0 ? start_count - 1 : 0; }
};

std::string ToJson(const TaskState& state);
// kInput if the text is no state; messages call it `name`.
Result<TaskState> ParseTaskState(std::string_view text, const std::string& name);

// A missing file is the state of a task that was never started. kInput: damaged.
Result<TaskState> ReadTaskState(const std::filesystem::path& path);
Result<void> WriteTaskState(const TaskState& state, const std::filesystem::path& path);

// The last progress that lfrenderer wrote to a log (--progress json).
struct TaskProgress {
  uint64_t done = 0, total = 0;  // of `unit`; after a resume, of what was left
  std::string unit;
  double rate = 0;  // per second
  double seconds_left = 0;
  uint64_t image_done = 0, image_total = 0;  // LF images
  double quiet_s = 0;                        // since the log last grew
  std::string message;                       // the last line for people
};

// Parses any bytes and skips what is not understood. The result is that of the last start; until it
// reports its own, done and total are those of the previous start.
TaskProgress ParseProgress(std::string_view log);
// Parses the last lines of a log; without a log, nothing is known.
TaskProgress ReadProgress(const std::filesystem::path& log);

// Returns the lines for people since the last start.
std::vector<std::string> LinesOfLastStart(const std::filesystem::path& log);

// The line that separates starts in a log.
inline constexpr std::string_view kLogStart = "-- ";

}  // namespace lf
