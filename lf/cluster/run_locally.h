// Processes of this machine as the engine of a job.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "lf/cluster/job.h"
#include "lf/core/file_lock.h"
#include "lf/core/result.h"

namespace lf {

// Renders these packages, job.at_once at the same time, and finishes the film; returns when all is
// done. A package that fails does not keep the others from being rendered.
//   lock  of TakeJob()
//   look  called twice a second
// kInterrupted: `stop` or --cancel. kOutput: the state of a package could not be written, or
// another process has it. Else as FinishFilm().
Result<void> RunLocally(const ClusterJob& job, const FileLock& lock,
                        const std::vector<size_t>& numbers, const std::atomic<bool>& stop,
                        const std::function<void()>& look);

// The name of this machine; of a batch system's node, where it has one.
std::string NodeName();

}  // namespace lf
