// A job in a folder, from outside: begun, waited for, ended, gone on with.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "lf/cluster/job.h"
#include "lf/core/result.h"

namespace lf {

// Makes sure that the folder has no other job. With `overwrite` removes it, the states and the
// frames of these packages. kUsage: there is one; kOutput: it is at work.
Result<void> MakeRoomForJob(const ClusterJob& job, bool overwrite);

// Takes back what ended the job, and lists the packages to be begun: those that are neither
// done nor queued. Crashes before count no more. kOutput: the local engine is at work.
Result<std::vector<size_t>> PrepareResume(const ClusterJob& job);

// Asks all packages to write their states and to end, and waits for them, or for `stop`.
Result<void> CancelJob(const ClusterJob& job, const std::atomic<bool>& stop);

// Until nothing of the job is at work or queued, or `stop`, which ends the waiting alone. The error
// is that of the finishing task.
//   look  called every few seconds
Result<void> WaitForJob(const ClusterJob& job, const std::atomic<bool>& stop,
                        const std::function<void()>& look);

}  // namespace lf
