// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/job_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "lf/core/file_lock.h"
#include "lf/core/spelling.h"
#include "lf/distribute/cluster/slurm.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kLongQuiet_s = 10;

// Returns the names of all files in a folder. One listing is faster than a million single queries
// to a file server.
std::set<std::string> NamesIn(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    names.insert(entry.path().filename().string());
  return names;
}

// Returns the part of a task's status that its state file and its log contain.
TaskStatus LookAtTask(const ClusterTask& task) {
  TaskStatus status;
  status.name = task.name;
  const Result<TaskState> state = ReadTaskState(task.state);
  if (!state) {
    status.message = state.error().message;
    return status;
  }
  status.state = *state;
  const TaskProgress progress = ReadProgress(task.log);
  status.message = state->message.empty() ? progress.message : state->message;
  if (state->start_count == 0 || state->phase == TaskPhase::kDone) return status;
  status.rays_left =
      progress.total > 0 ? std::optional(progress.total - progress.done) : std::nullopt;
  status.image_done = progress.image_done;
  status.image_total = progress.image_total;
  if (state->phase != TaskPhase::kRunning) return status;
  // lfrenderer reports its progress every second. If it is silent for kLongQuiet_s, its node may be
  // dead, which a batch system notices only later.
  if (progress.quiet_s > kLongQuiet_s) {
    status.message = fmt::format("has not reported progress for {:.0f} s", progress.quiet_s);
    return status;
  }
  if (progress.rate <= 0) return status;
  status.unit = progress.unit;
  status.rate = progress.rate;
  status.seconds_left = progress.seconds_left;
  return status;
}

void TakeFacts(const ClusterJob& job, const JobPackage& package, const std::set<std::string>& names,
               TaskStatus* status) {
  status->frame_total = package.frames.size();
  status->ray_total = package.ray_count;
  if (status->state.start_count == 0) return;  // any existing frames are from another render
  for (const FrameId frame : package.frames)
    if (names.contains(fmt::format("frame_{:04}{}", frame.value, job.frame_extension)))
      ++status->frames_done;
  if (status->rays_left)
    status->rays_done = status->ray_total - std::min(*status->rays_left, status->ray_total);
  if (status->state.phase == TaskPhase::kDone) status->rays_done = status->ray_total;
}

void TakeQueue(const std::vector<QueuedTask>& queue, JobStatus* status) {
  for (const QueuedTask& queued : queue) {
    TaskStatus& task = queued.is_finishing ? status->finishing : status->packages[queued.number];
    task.queue = queued.state;
    if (queued.state == "PENDING") {
      task.message = queued.reason;
      // A pending task that "runs" was requeued, and has not started again yet.
      if (task.state.phase == TaskPhase::kRunning) task.state.phase = TaskPhase::kInterrupted;
    }
  }
}

void NoteLost(TaskStatus* task) {
  if (task->state.phase != TaskPhase::kRunning) return;
  task->state.phase = TaskPhase::kInterrupted;
  task->message = "its process has died; its checkpoint is kept";
  task->seconds_left.reset();
}

TaskPhase PhaseOf(const JobStatus& status, bool is_engine_at_work) {
  std::vector<const TaskStatus*> tasks = {&status.finishing};
  for (const TaskStatus& package : status.packages) tasks.push_back(&package);
  const auto any = [&](auto is) { return std::any_of(tasks.begin(), tasks.end(), is); };
  const auto has = [&](TaskPhase phase) {
    return any([=](const TaskStatus* task) { return task->state.phase == phase; });
  };
  if (status.finishing.state.phase == TaskPhase::kDone &&
      status.Count(TaskPhase::kDone) == status.packages.size() &&
      status.frames_done() == status.frame_total())
    return TaskPhase::kDone;
  if (is_engine_at_work || has(TaskPhase::kRunning)) return TaskPhase::kRunning;
  const bool was_begun = any([](const TaskStatus* task) { return task->state.start_count > 0; });
  if (any([](const TaskStatus* task) { return task->IsQueued(); }))
    return was_begun ? TaskPhase::kRunning : TaskPhase::kWaiting;
  if (has(TaskPhase::kFailed)) return TaskPhase::kFailed;
  return was_begun ? TaskPhase::kInterrupted : TaskPhase::kWaiting;
}

Json TaskToJson(const TaskStatus& task) {
  Json json = {{"name", task.name},
               {"state", NameOf(task.state.phase)},
               {"node", task.state.node},
               {"process", task.state.process},
               {"frames_done", task.frames_done},
               {"frames", task.frame_total},
               {"share", task.DoneShare()},
               {"lf_images_done", task.image_done},
               {"lf_images", task.image_total},
               {"restarts", task.state.restart_count()},
               {"crashes", task.state.crash_count},
               {"exit_code", task.state.exit_code},
               {"message", Spelled(task.message)}};
  if (!task.queue.empty()) json["queue"] = task.queue;
  if (task.rate > 0) json[task.unit + "_per_second"] = task.rate;
  if (task.seconds_left) json["seconds_left"] = *task.seconds_left;
  return json;
}

}  // namespace

size_t JobStatus::Count(TaskPhase wanted) const {
  return static_cast<size_t>(
      std::count_if(packages.begin(), packages.end(),
                    [=](const TaskStatus& task) { return task.state.phase == wanted; }));
}

size_t JobStatus::frames_done() const {
  return std::transform_reduce(packages.begin(), packages.end(), size_t{0}, std::plus<>(),
                               [](const TaskStatus& task) { return task.frames_done; });
}
size_t JobStatus::frame_total() const {
  return std::transform_reduce(packages.begin(), packages.end(), size_t{0}, std::plus<>(),
                               [](const TaskStatus& task) { return task.frame_total; });
}
uint64_t JobStatus::rays_done() const {
  return std::transform_reduce(packages.begin(), packages.end(), uint64_t{0}, std::plus<>(),
                               [](const TaskStatus& task) { return task.rays_done; });
}
uint64_t JobStatus::ray_total() const {
  return std::transform_reduce(packages.begin(), packages.end(), uint64_t{0}, std::plus<>(),
                               [](const TaskStatus& task) { return task.ray_total; });
}

std::optional<double> JobStatus::seconds_left() const {
  double rate = 0;
  for (const TaskStatus& task : packages)
    if (task.state.phase == TaskPhase::kRunning) rate += task.rate;
  if (rate <= 0) return std::nullopt;
  double left_s = static_cast<double>(ray_total() - rays_done()) / rate;
  for (const TaskStatus& task : packages)
    if (task.seconds_left) left_s = std::max(left_s, *task.seconds_left);
  return left_s;
}

JobStatus LookAtJob(const ClusterJob& job) {
  JobStatus status;
  status.is_cancelled = job.IsCancelled();
  const std::set<std::string> names = NamesIn(job.output_folder);
  for (size_t i = 0; i < job.packages.size(); ++i) {
    status.packages.push_back(LookAtTask(PackageTask(job, i)));
    TakeFacts(job, job.packages[i], names, &status.packages.back());
  }
  status.finishing = LookAtTask(FinishingTask(job));
  if (job.engine == ClusterEngine::kSlurm) {
    if (const auto queue = AskSlurm(job)) {
      TakeQueue(*queue, &status);
      for (TaskStatus& task : status.packages)
        if (!task.IsQueued()) NoteLost(&task);
      if (!status.finishing.IsQueued()) NoteLost(&status.finishing);
    } else {
      status.queue_error = queue.error().message;
    }
  } else {
    for (size_t i = 0; i < job.packages.size(); ++i)
      if (status.packages[i].state.phase == TaskPhase::kRunning &&
          !FileLock::IsHeld(PackageTask(job, i).lock))
        NoteLost(&status.packages[i]);
    if (!FileLock::IsHeld(FinishingTask(job).lock)) NoteLost(&status.finishing);
  }
  status.phase = PhaseOf(status, FileLock::IsHeld(job.EngineLock()));
  return status;
}

std::string ToJson(const ClusterJob& job, const JobStatus& status) {
  Json packages = Json::array();
  for (const TaskStatus& task : status.packages) packages.push_back(TaskToJson(task));
  Json json = {{"format", "lfstatus 1"},
               {"state", NameOf(status.phase)},
               {"engine", NameOf(job.engine)},
               {"cancelled", status.is_cancelled},
               {"frames_done", status.frames_done()},
               {"frames", status.frame_total()},
               {"rays_done", status.rays_done()},
               {"rays", status.ray_total()},
               {"packages", std::move(packages)},
               {"finishing", TaskToJson(status.finishing)}};
  if (const auto left_s = status.seconds_left()) json["seconds_left"] = *left_s;
  if (!status.queue_error.empty()) json["queue_error"] = Spelled(status.queue_error);
  return RecordText(json);
}

}  // namespace lf
