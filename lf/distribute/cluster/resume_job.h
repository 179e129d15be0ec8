// Starts, resumes, cancels and waits for a job in a folder, from outside.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "lf/core/file_lock.h"
#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// Locks the job's folder, which is created if it is missing. Held by the program that submits,
// resumes or locally renders the job. kOutput: the disk; another program holds the lock, and the
// message names its process.
Result<FileLock> TakeJob(const ClusterJob& job);

// Makes sure that the folder holds no other job. With `overwrite`, removes the old job, and the
// states and frames of these packages. To be called under TakeJob(). kUsage: there is a job, or one
// that is running.
Result<void> MakeRoomForJob(const ClusterJob& job, bool overwrite);

// Removes the request to cancel the job, and returns the packages to start: those that are neither
// done nor queued. Their count of crashes is reset. To be called under TakeJob(). kOutput.
Result<std::vector<size_t>> PrepareResume(const ClusterJob& job);

// Asks all packages to write a checkpoint and end, and waits for them or for `stop`.
Result<void> CancelJob(const ClusterJob& job, const std::atomic<bool>& stop);

// Waits until no task of the job runs or is queued, or until `stop`, which leaves the job running.
// Returns the error of the finishing task.
//   look  called every few seconds
Result<void> WaitForJob(const ClusterJob& job, const std::atomic<bool>& stop,
                        const std::function<void()>& look);

}  // namespace lf
