// Runs a job by processes of this machine.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "lf/core/file_lock.h"
#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// Renders these packages, job.at_once at the same time, then finishes the film. Returns when all is
// done. A failed package does not stop the others.
//   lock  of TakeJob()
//   look  called twice a second
// kInterrupted: `stop` or --cancel. Otherwise the first error of RunPackage(), such as a state that
// cannot be read or written, or the result of FinishFilm().
Result<void> RunLocally(const ClusterJob& job, const FileLock& lock,
                        const std::vector<size_t>& numbers, const std::atomic<bool>& stop,
                        const std::function<void()>& look);

// Returns the name of this machine, or the node name that a batch system gave it.
std::string NodeName();

}  // namespace lf
