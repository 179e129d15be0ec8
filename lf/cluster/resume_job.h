// A job in a folder, from outside: begun, waited for, ended, gone on with.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "lf/cluster/job.h"
#include "lf/core/file_lock.h"
#include "lf/core/result.h"

namespace lf {

// Locks the job's folder, which is made if it is missing: held by whoever submits, resumes or
// renders here. kOutput: another program has it, and the message names its process; the disk.
Result<FileLock> TakeJob(const ClusterJob& job);

// Makes sure that the folder has no other job. With `overwrite` removes it, the states and the
// frames of these packages. To be called under TakeJob(). kUsage: there is one, or one at work.
Result<void> MakeRoomForJob(const ClusterJob& job, bool overwrite);

// To be called under TakeJob(). Takes back what ended the job, and lists the packages to be begun:
// those that are neither done nor queued. Crashes before count no more. kOutput.
Result<std::vector<size_t>> PrepareResume(const ClusterJob& job);

// Asks all packages to write their states and to end, and waits for them, or for `stop`.
Result<void> CancelJob(const ClusterJob& job, const std::atomic<bool>& stop);

// Until nothing of the job is at work or queued, or `stop`, which ends the waiting alone. The error
// is that of the finishing task.
//   look  called every few seconds
Result<void> WaitForJob(const ClusterJob& job, const std::atomic<bool>& stop,
                        const std::function<void()>& look);

}  // namespace lf
