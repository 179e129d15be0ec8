// How far a job is, read from its files (and the queue of a batch system): nothing is asked of the
// programs at work.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lf/cluster/job.h"
#include "lf/cluster/task_state.h"

namespace lf {

struct TaskStatus {
  std::string name;
  TaskState state;      // phase kInterrupted where it is said to run and nobody does
  std::string queue;    // of a batch system: "PENDING", ...; empty: not queued
  std::string message;  // the last that is known
  size_t frames_done = 0;
  size_t frame_total = 0;
  std::optional<uint64_t> rays_left;  // as lfrenderer said last
  uint64_t rays_done = 0;             // of the forecast
  uint64_t ray_total = 0;
  uint64_t image_done = 0;  // LF images of this start
  uint64_t image_total = 0;
  double rate = 0;  // `unit` a second, while it runs
  std::string unit;
  std::optional<double> seconds_left;

  bool IsQueued() const { return !queue.empty(); }
  double Share() const {
    return ray_total > 0 ? static_cast<double>(rays_done) / static_cast<double>(ray_total)
                         : static_cast<double>(state.phase == TaskPhase::kDone);
  }
};

// Of the whole: kWaiting, kRunning while anything does or is queued, kDone with the finishing task;
// kFailed if nothing goes on and something failed, else kInterrupted.
struct JobStatus {
  TaskPhase phase = TaskPhase::kWaiting;
  bool is_cancelled = false;
  std::vector<TaskStatus> packages;
  TaskStatus finishing;
  std::string queue_error;  // why a batch system could not be asked

  size_t Count(TaskPhase phase) const;  // packages
  size_t frames_done() const;
  size_t frame_total() const;
  uint64_t rays_done() const;
  uint64_t ray_total() const;
  // From the rates of those that run; none while none has one.
  std::optional<double> seconds_left() const;
};

// Damaged states are told as messages of their tasks.
JobStatus LookAtJob(const ClusterJob& job);

// For programs.
std::string ToJson(const ClusterJob& job, const JobStatus& status);

}  // namespace lf
