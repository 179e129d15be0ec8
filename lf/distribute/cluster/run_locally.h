// SPDX-License-Identifier: Apache-2.0
// Runs a job with processes of this machine.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "lf/core/file_lock.h"
#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// Renders some packages of the job, job.at_once of them at the same time (at least one), then
// finishes the film with FinishFilm(). Returns when everything is done. A failed package does not
// stop the others.
//   lock     the lock of TakeJob(), which the caller must hold
//   numbers  indices of the packages in job.packages
//   look     called about twice a second
// Returns kInterrupted if `stop` became true or the job was cancelled; otherwise the first error of
// RunPackage(), such as a state that cannot be read or written; otherwise the result of
// FinishFilm().
Result<void> RunLocally(const ClusterJob& job, const FileLock& lock,
                        const std::vector<size_t>& numbers, const std::atomic<bool>& stop,
                        const std::function<void()>& look);

// Returns the node name that Slurm gave to this machine; outside of Slurm, the host name.
std::string NodeName();

}  // namespace lf
