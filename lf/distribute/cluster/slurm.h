// Slurm as the engine of a job: an array of tasks over the packages, followed by a finishing task.
// It is controlled by sbatch, squeue and scancel only: sacct needs a database that many clusters
// lack.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// A task of ours in the answer of squeue.
struct QueuedTask {
  bool is_finishing = false;
  size_t number = 0;   // of the package
  std::string state;   // "PENDING", "RUNNING", "COMPLETING", ...
  std::string node;    // empty while it waits
  std::string reason;  // why it waits
};

// The batch scripts, DIR/cluster/packages.sbatch and finish.sbatch. People may read and edit them
// and give them to sbatch by hand.
std::string PackagesScript(const ClusterJob& job);
std::string FinishingScript(const ClusterJob& job);

// Returns "0-3,7", the syntax of sbatch --array, for ascending numbers.
std::string ArrayText(const std::vector<size_t>& numbers);

// Writes the scripts and submits these packages, then the finishing task, which replaces a waiting
// one. It depends on the packages with afterany, because afterok would wait for ever after a
// requeue. Stores the ids in the job and writes it. kUsage: a path with control characters.
// kOutput: sbatch refuses; then waiting tasks are cancelled, and a job that never had a task is
// removed.
Result<void> SubmitToSlurm(ClusterJob* job, const std::vector<size_t>& numbers);

// Returns the tasks of the job that Slurm still knows, without those that are done. kOutput: squeue
// fails.
Result<std::vector<QueuedTask>> AskSlurm(const ClusterJob& job);
// Parses lines "ARRAY_ID|INDEX|STATE|NODE|REASON" of squeue and skips others.
std::vector<QueuedTask> ParseQueue(std::string_view text, const ClusterJob& job);

// Cancels waiting tasks. Running ones see the job's cancel file, write a checkpoint and end.
Result<void> CancelInSlurm(const ClusterJob& job);
// Lets requeued tasks start at once; Slurm would make them wait for two minutes.
Result<void> ReleaseInSlurm(const ClusterJob& job);

}  // namespace lf
