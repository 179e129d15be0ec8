// A job at work, before the eyes of whoever called lfsubmit.
#pragma once

#include <vector>

#include "tools/common/program.h"

#include "lf/cluster/job.h"
#include "lf/core/file_lock.h"
#include "lf/core/result.h"

namespace lf {

// Has these packages rendered by the engine that the job has: until the film is done, or, where
// that is Slurm and nobody waits, until they are submitted. kBelowRequired if the film is done, but
// LF images were left out, or frames are below what was required.
//   lock  of TakeJob(); let go of when no process here is at work any more
Result<void> RunJob(ClusterJob job, FileLock lock, const std::vector<size_t>& numbers, bool waits,
                    const CommonOptions& common);

}  // namespace lf
