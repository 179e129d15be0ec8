// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/resume_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/log.h"
#include "lf/core/shell_word.h"
#include "lf/distribute/cluster/job_status.h"
#include "lf/distribute/cluster/run_package.h"
#include "lf/distribute/cluster/slurm.h"
#include "lf/distribute/cluster/task_state.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

bool HasTasksAtWork(const JobStatus& status) {
  const auto is_at_work = [](const TaskStatus& task) {
    return task.state.phase == TaskPhase::kRunning || task.IsQueued();
  };
  return is_at_work(status.finishing) ||
         std::any_of(status.packages.begin(), status.packages.end(), is_at_work);
}

bool IsAtWork(const JobStatus& status) {
  return status.phase == TaskPhase::kRunning || HasTasksAtWork(status);
}

void RemoveFrames(const ClusterJob& job, const JobPackage& package) {
  std::error_code ignored;
  for (const FrameId frame : package.frames)
    fs::remove(job.output_folder / fmt::format("frame_{:04}{}", frame.value, job.frame_extension),
               ignored);
  fs::remove(job.output_folder / ("report-" + package.name + ".json"), ignored);
  fs::remove_all(job.output_folder / "partial" / package.name, ignored);
}

// Sleeps in short steps, so that it returns soon after `stop` becomes true.
void SleepOr(const std::atomic<bool>& stop, double seconds) {
  for (int i = 0; i < 10 * seconds && !stop; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

// Removes all files of the job, except for the lock that the caller holds.
void RemoveJob(const ClusterJob& job) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (auto entry = fs::directory_iterator(job.Folder(), ignored);
       !ignored && entry != fs::directory_iterator(); entry.increment(ignored))
    files.push_back(entry->path());
  for (const fs::path& file : files)
    if (!FileLock::IsPart(job.EngineLock(), file)) fs::remove_all(file, ignored);
}

}  // namespace

Result<FileLock> TakeJob(const ClusterJob& job) {
  LF_RETURN_IF_ERROR(CreateFolder(job.Folder()));
  Result<FileLock> lock = FileLock::Take(job.EngineLock());
  if (lock || !FileLock::IsHeld(job.EngineLock())) return lock;
  return OutputError(fmt::format("{}, or end its job: {}", lock.error().message,
                                 JobCommand("--cancel", job.output_folder)));
}

Result<void> MakeRoomForJob(const ClusterJob& job, bool overwrite) {
  std::error_code ignored;
  if (!fs::exists(job.File(), ignored) && !overwrite) return {};
  const Result<ClusterJob> before = ReadJob(job.output_folder);
  if (!overwrite && !before) return before.error();
  if (!overwrite)
    return UsageError(fmt::format(
        "{}: contains a job already: remove it and its frames with {{overwrite}} (to remove the "
        "job and keep its frames, remove {}), or continue it: {}",
        job.output_folder.string(), job.Folder().string(), ResumeCommand(job)));
  if (before && HasTasksAtWork(LookAtJob(*before)))
    return UsageError(fmt::format("{}: the job in this folder is still running: end it first: {}",
                                  job.output_folder.string(),
                                  JobCommand("--cancel", job.output_folder)));
  for (const JobPackage& package : job.packages) RemoveFrames(job, package);
  RemoveJob(job);
  return {};
}

Result<std::vector<size_t>> PrepareResume(const ClusterJob& job) {
  std::error_code ignored;
  fs::remove(job.CancelFile(), ignored);
  if (job.engine == ClusterEngine::kSlurm) LF_RETURN_IF_ERROR(ReleaseInSlurm(job));
  const JobStatus status = LookAtJob(job);
  if (!status.queue_error.empty()) return OutputError(status.queue_error);
  std::vector<size_t> numbers;
  for (size_t i = 0; i < job.packages.size(); ++i) {
    const TaskStatus& task = status.packages[i];
    const bool is_done =
        task.state.phase == TaskPhase::kDone && task.frames_done == task.frame_total;
    if (is_done || task.IsQueued()) continue;
    numbers.push_back(i);
    // A package that still runs will end soon, because its engine has died: the caller holds the
    // job's lock. RunPackage() waits for the package's lock. The state of the package is not
    // changed here.
    if (task.state.start_count == 0 || task.state.phase == TaskPhase::kRunning) continue;
    TaskState state = task.state;
    state.phase = TaskPhase::kInterrupted;
    state.crash_count = 0;
    LF_RETURN_IF_ERROR(WriteTaskState(state, PackageTask(job, i).state));
  }
  // If the film was finished before, a part of it is missing now or is asked for with new options.
  // The state of the finishing task is removed, so that the job is not reported as done until the
  // task has run again.
  if (status.finishing.state.phase == TaskPhase::kDone && !status.finishing.IsQueued()) {
    std::error_code error;
    fs::remove(FinishingTask(job).state, error);
    if (error)
      return OutputError(fmt::format("{}: cannot be removed: {}", FinishingTask(job).state.string(),
                                     error.message()));
  }
  LogInfo("continuing: {} of {} packages are done", status.Count(TaskPhase::kDone),
          job.packages.size());
  return numbers;
}

Result<void> CancelJob(const ClusterJob& job, const std::atomic<bool>& stop) {
  constexpr double kPatience_s = 180;
  if (LookAtJob(job).phase == TaskPhase::kDone) {
    LogInfo("{}: the film is done: there is nothing to cancel", job.output_folder.string());
    return {};
  }
  LF_RETURN_IF_ERROR(WriteFileAtomically(job.CancelFile(), ""));
  if (job.engine == ClusterEngine::kSlurm) LF_RETURN_IF_ERROR(CancelInSlurm(job));
  JobStatus status = LookAtJob(job);
  for (double waited_s = 0; IsAtWork(status) && waited_s < kPatience_s && !stop; waited_s += 1) {
    SleepOr(stop, 1);
    // Also cancels tasks that were requeued in the meantime.
    if (job.engine == ClusterEngine::kSlurm) LF_RETURN_IF_ERROR(CancelInSlurm(job));
    status = LookAtJob(job);
  }
  if (IsAtWork(status))
    return OutputError(fmt::format(
        "{} packages are still running: they end when they notice the file {}; to see whether "
        "they have ended: {}",
        status.Count(TaskPhase::kRunning), job.CancelFile().string(),
        JobCommand("--status", job.output_folder)));
  LogInfo(
      "cancelled: {} of {} frames are done, and the state of the others is kept; to continue: {}",
      status.frames_done(), status.frame_total(), ResumeCommand(job));
  return {};
}

Result<void> WaitForJob(const ClusterJob& job, const std::atomic<bool>& stop,
                        const std::function<void()>& look) {
  while (true) {
    look();
    const JobStatus status = LookAtJob(job);
    if (!IsAtWork(status) && status.queue_error.empty())
      return OutcomeOf("the finishing task", status.finishing.state);
    if (job.engine == ClusterEngine::kSlurm)
      if (const Result<void> released = ReleaseInSlurm(job); !released)
        LogWarning("{}", released.error().message);
    SleepOr(stop, 3);
    if (stop)
      return Error{ErrorKind::kInterrupted,
                   fmt::format("no longer waiting; the job continues; to see its progress: {}",
                               JobCommand("--status", job.output_folder))};
  }
}

}  // namespace lf
