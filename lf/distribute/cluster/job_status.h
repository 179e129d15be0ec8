// The progress of a job, read from its files and the queue of a batch system; running programs are
// not asked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lf/distribute/cluster/job.h"
#include "lf/distribute/cluster/task_state.h"

namespace lf {

struct TaskStatus {
  std::string name;
  TaskState state;      // phase kInterrupted if the file says kRunning but no process runs
  std::string queue;    // state in a batch system: "PENDING", ...; empty: not queued
  std::string message;  // the latest known message
  size_t frames_done = 0;
  size_t frame_total = 0;
  std::optional<uint64_t> rays_left;  // as lfrenderer reported last
  uint64_t rays_done = 0;             // out of ray_total, the forecast
  uint64_t ray_total = 0;
  uint64_t image_done = 0;  // LF images since the last start
  uint64_t image_total = 0;
  double rate = 0;  // `unit` per second, while the task runs
  std::string unit;
  std::optional<double> seconds_left;

  bool IsQueued() const { return !queue.empty(); }
  double DoneShare() const {
    return ray_total > 0 ? static_cast<double>(rays_done) / static_cast<double>(ray_total)
                         : static_cast<double>(state.phase == TaskPhase::kDone);
  }
};

// The phase of the whole job is kDone if all packages, all frames and the finishing task are done.
// Otherwise it is kRunning while the engine or a task runs, or a task is queued after a start;
// kFailed if a task failed; kInterrupted if a task was started; else kWaiting.
struct JobStatus {
  TaskPhase phase = TaskPhase::kWaiting;
  bool is_cancelled = false;
  std::vector<TaskStatus> packages;
  TaskStatus finishing;
  std::string queue_error;  // why the batch system could not be asked

  size_t Count(TaskPhase phase) const;  // number of packages
  size_t frames_done() const;
  size_t frame_total() const;
  uint64_t rays_done() const;
  uint64_t ray_total() const;
  // Estimated from the rates of running tasks; nullopt if none has a rate.
  std::optional<double> seconds_left() const;
};

// Reads the status. A damaged state becomes the message of its task.
JobStatus LookAtJob(const ClusterJob& job);

// Returns the status for other programs.
std::string ToJson(const ClusterJob& job, const JobStatus& status);

}  // namespace lf
