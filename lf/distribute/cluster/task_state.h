// SPDX-License-Identifier: Apache-2.0
// The state of a task of a job, in a small file: the lfsubmit process that runs the task writes it,
// and `lfsubmit --resume` resets it. Also reads the progress of the task from the log of
// lfrenderer.
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
  kRunning,      // running, unless its process or node has died
  kInterrupted,  // resumes from its checkpoint when it is started again
  kDone,
  kFailed,  // would probably fail again if it were restarted
};
const char* NameOf(TaskPhase phase);

struct TaskState {
  TaskPhase phase = TaskPhase::kWaiting;
  std::string node;          // name of the machine where the task was last started
  int64_t process = 0;       // process id of lfrenderer on `node`
  uint32_t start_count = 0;  // number of starts of lfrenderer
  uint32_t crash_count = 0;  // number of crashes of lfrenderer or its node
  int exit_code = 0;         // exit code of lfrenderer, or of lfsubmit if lfrenderer has none; 0
                             // after a crash; 0 or 6 if `phase` is kDone
  std::string message;       // why the task does not run, or why its exit code is not 0
  double begin_s = 0;        // time of the last start, in seconds since 1970
  double end_s = 0;          // time of the last end, in seconds since 1970

  uint32_t restart_count() const { return start_count > 0 ? start_count - 1 : 0; }
};

std::string ToJson(const TaskState& state);
// Parses the text of ToJson(). kInput if it is no valid state; the message begins with `name`.
Result<TaskState> ParseTaskState(std::string_view text, const std::string& name);

// Reads the state of a task; if the file is missing, returns the state of a task that was never
// started. kInput: the file is damaged.
Result<TaskState> ReadTaskState(const std::filesystem::path& path);
Result<void> WriteTaskState(const TaskState& state, const std::filesystem::path& path);

// The last progress that lfrenderer wrote to its log (--progress json).
struct TaskProgress {
  uint64_t done = 0, total = 0;  // work in `unit`; after a resume, without the work done before
  std::string unit;
  double rate = 0;  // in `unit` per second
  double seconds_left = 0;
  uint64_t image_done = 0, image_total = 0;  // numbers of LF images: read, and to be read in all
  double quiet_s = 0;                        // seconds since the log was last written
  std::string message;                       // last message in the log since the last start
};

// Returns the progress of the last start in a log. Until this start has reported progress, unit,
// done and total are those of the previous start. The log may be any bytes: lines that begin with
// '{' but are no progress are skipped; all other lines are messages.
TaskProgress ParseProgress(std::string_view log);
// Returns ParseProgress() of the last 16 KiB of a log file, with quiet_s; an empty progress if
// there is no file.
TaskProgress ReadProgress(const std::filesystem::path& log);

// Returns the messages since the last start, as far as they are in the last 16 KiB of the log.
std::vector<std::string> LinesOfLastStart(const std::filesystem::path& log);

// Beginning of the header line that precedes the output of each start of lfrenderer in a log.
inline constexpr std::string_view kLogStart = "-- ";

}  // namespace lf
