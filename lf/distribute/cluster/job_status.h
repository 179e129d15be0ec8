// SPDX-License-Identifier: Apache-2.0
// The progress of a job. It is read from the job's files and from the queue of the batch system,
// without contact to running programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lf/distribute/cluster/job.h"
#include "lf/distribute/cluster/task_state.h"

namespace lf {

struct TaskStatus {
  std::string name;
  TaskState state;      // its phase is kInterrupted if the file says kRunning but no process runs
  std::string queue;    // state in the batch system, such as "PENDING"; empty: not queued
  std::string message;  // latest message of the task
  size_t frames_done = 0;
  size_t frame_total = 0;
  // Number of rays left, by lfrenderer's last progress, if any. The progress counts LF pixels that
  // are tested, as ray_total does, whether its unit is called "rays" or "px".
  std::optional<uint64_t> rays_left;
  uint64_t rays_done = 0;  // number of the forecast ray_total rays that are done
  uint64_t ray_total = 0;
  uint64_t image_done = 0;  // number of LF images read since the last start
  uint64_t image_total = 0;
  double rate = 0;  // in `unit` per second; 0 if the task does not run, or reports nothing
  std::string unit;
  std::optional<double> seconds_left;

  bool IsQueued() const { return !queue.empty(); }
  double DoneShare() const {
    return ray_total > 0 ? static_cast<double>(rays_done) / static_cast<double>(ray_total)
                         : static_cast<double>(state.phase == TaskPhase::kDone);
  }
};

// The phase of the whole job is the first of these that applies:
//   kDone         all packages, all frames and the finishing task are done
//   kRunning      the local engine or a task runs
//   kRunning      a task is queued, and any task was ever started
//   kWaiting      a task is queued
//   kFailed       a task failed
//   kInterrupted  any task was ever started
//   kWaiting      otherwise
struct JobStatus {
  TaskPhase phase = TaskPhase::kWaiting;
  bool is_cancelled = false;
  std::vector<TaskStatus> packages;
  TaskStatus finishing;
  std::string queue_error;  // why the queue of the batch system could not be read; empty: no error

  size_t Count(TaskPhase phase) const;  // number of packages in this phase
  size_t frames_done() const;
  size_t frame_total() const;
  uint64_t rays_done() const;
  uint64_t ray_total() const;
  // Returns an estimate from the rates of running packages; nullopt if none has a rate.
  std::optional<double> seconds_left() const;
};

// Reads the status. If the state of a task is damaged, TaskStatus::message says so.
JobStatus LookAtJob(const ClusterJob& job);

// Returns the status as JSON for other programs.
std::string ToJson(const ClusterJob& job, const JobStatus& status);

}  // namespace lf
