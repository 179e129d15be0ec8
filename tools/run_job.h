// SPDX-License-Identifier: Apache-2.0
// Runs a job while the caller of lfsubmit watches its progress.
#pragma once

#include <string>
#include <vector>

#include "tools/common/program.h"

#include "lf/core/file_lock.h"
#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

struct RunJobOptions {
  bool waits = false;  // true: RunJob() returns when Slurm has rendered the film
  // Folder that gets the files for a farm; empty: a folder of the job.
  std::string write;
};

// Renders the packages with the indices `numbers` (in ClusterJob::packages) with the engine of the
// job. Returns when the film is done or, with Slurm and without `waits`, when the tasks are
// submitted. Only writes the files of farm_files.h if a farm renders the job. kBelowRequired if the
// film is done but LF images were left out, or frames are below what was required.
//   lock  the lock that TakeJob() returned; it is released when no local process works on the job
//         any more
Result<void> RunJob(ClusterJob job, FileLock lock, const std::vector<size_t>& numbers,
                    const RunJobOptions& options, const CommonOptions& common);

}  // namespace lf
