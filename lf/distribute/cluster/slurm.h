// SPDX-License-Identifier: Apache-2.0
// Slurm as the engine of a job: an array of tasks, one for each package, followed by a finishing
// task. Slurm is controlled with sbatch, squeue, scancel and scontrol. sacct is not used, because
// it needs a database that many clusters lack.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// A task of the job that squeue lists.
struct QueuedTask {
  bool is_finishing = false;
  size_t number = 0;   // index in job.packages; unused for the finishing task
  std::string state;   // "PENDING", "RUNNING", "COMPLETING", ...
  std::string node;    // node that runs the task; empty while the task waits
  std::string reason;  // why the task waits, in Slurm's words
};

// These functions return the texts of the batch scripts DIR/cluster/packages.sbatch and
// finish.sbatch. People may edit these files and submit them with sbatch by hand.
std::string PackagesScript(const ClusterJob& job);
std::string FinishingScript(const ClusterJob& job);

// Returns a text such as "0-3,7", in the syntax of sbatch --array.
//   numbers  ascending
std::string ArrayText(const std::vector<size_t>& numbers);

// Writes the scripts, and submits some packages (`numbers`: indices in job->packages) and then the
// finishing task. An earlier finishing task that waits or runs is cancelled. The finishing task
// depends on the packages with afterany, because afterok would wait for ever if a task was
// requeued. Stores the ids of the submissions in the job and writes job.json. kUsage: a path
// contains control characters. kOutput: sbatch fails, or the disk.
// If sbatch refuses the packages of a new job, job.json is removed; if it refuses the finishing
// task, waiting tasks are cancelled.
Result<void> SubmitToSlurm(ClusterJob* job, const std::vector<size_t>& numbers);

// Returns the tasks of the job that Slurm lists; tasks that are done are not listed. kOutput:
// squeue fails.
Result<std::vector<QueuedTask>> AskSlurm(const ClusterJob& job);
// Parses lines "ARRAY_ID|INDEX|STATE|NODE|REASON" of squeue, and skips lines of other jobs or in
// another form.
std::vector<QueuedTask> ParseQueue(std::string_view text, const ClusterJob& job);

// Cancels the waiting tasks. Running tasks see ClusterJob::CancelFile(), write a checkpoint and
// end. kOutput: scancel fails.
Result<void> CancelInSlurm(const ClusterJob& job);
// Lets requeued packages start at once. Slurm would otherwise delay them by two minutes. kOutput: a
// command of Slurm cannot be run.
Result<void> ReleaseInSlurm(const ClusterJob& job);

}  // namespace lf
