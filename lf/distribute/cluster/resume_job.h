// SPDX-License-Identifier: Apache-2.0
// Prepares to start or resume a job in a folder, cancels it, or waits for it, without being its
// engine.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "lf/core/file_lock.h"
#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// Creates the job's folder if it is missing, and locks it. A program holds this lock while it
// submits, resumes or locally renders the job. kOutput: the disk fails; another process holds the
// lock (the message names the process).
Result<FileLock> TakeJob(const ClusterJob& job);

// Makes sure that the folder contains no other job. If `overwrite` is true, removes the old job,
// and the frames, reports and checkpoints of the packages of `job`. The caller must hold the lock
// of TakeJob(). kUsage: there is a job and `overwrite` is false, or its tasks run or are queued.
// kInput: `overwrite` is false, and the file of the old job is damaged.
Result<void> MakeRoomForJob(const ClusterJob& job, bool overwrite);

// Removes the request to cancel the job, and returns the packages to start, as indices in
// job.packages: those that are neither done nor queued. A package that still runs may be among
// them, because its lfsubmit may have died; RunPackage() waits until it has ended. Resets the crash
// counts of the returned packages that do not run. If the finishing task is done and not queued,
// removes its state, so that it runs again. With Slurm, lets requeued packages start at once. The
// caller must hold the lock of TakeJob(). kOutput: Slurm does not answer, or a file cannot be
// written or removed.
Result<std::vector<size_t>> PrepareResume(const ClusterJob& job);

// Requests all packages to write a checkpoint and end, and waits until they have ended. Does
// nothing if the job is done. kOutput: some packages still run after about three minutes, or when
// `stop` becomes true (they end later); the request cannot be written, or Slurm does not answer.
Result<void> CancelJob(const ClusterJob& job, const std::atomic<bool>& stop);

// Waits until no task of the job runs or is queued, and returns the outcome of the finishing task
// (OutcomeOf()). kInterrupted: `stop` became true; the job continues.
//   look  called about every three seconds
Result<void> WaitForJob(const ClusterJob& job, const std::atomic<bool>& stop,
                        const std::function<void()>& look);

}  // namespace lf
