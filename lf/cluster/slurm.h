// Slurm as the engine of a job: one array of tasks over the packages, and a finishing task after
// it. Asked by sbatch, squeue and scancel alone: sacct needs a database that many clusters lack.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lf/cluster/job.h"
#include "lf/core/result.h"

namespace lf {

// What squeue says of a task of ours.
struct QueuedTask {
  bool is_finishing = false;
  size_t number = 0;   // of the package
  std::string state;   // "PENDING", "RUNNING", "COMPLETING", ...
  std::string node;    // empty while it waits
  std::string reason;  // why it waits
};

// The batch scripts, DIR/cluster/packages.sbatch and finish.sbatch: to be read, edited, and given
// to sbatch by hand.
std::string PackagesScript(const ClusterJob& job);
std::string FinishingScript(const ClusterJob& job);

// "0-3,7", as sbatch --array takes it; ascending numbers.
std::string ArrayText(const std::vector<size_t>& numbers);

// Writes the scripts and submits these packages, and after them (afterany: afterok would wait for
// ever for a task that was requeued) the finishing task in place of the one that waits. The job
// gets the ids and is written. kOutput: sbatch refuses; then nothing of it is queued, and a job
// that never was is no more.
Result<void> SubmitToSlurm(ClusterJob* job, const std::vector<size_t>& numbers);

// Tasks of the job that Slurm still knows; those that are done are not among them. kOutput: squeue
// cannot be asked.
Result<std::vector<QueuedTask>> AskSlurm(const ClusterJob& job);
// Lines "ARRAY_ID|INDEX|STATE|NODE|REASON" of squeue; others are left out.
std::vector<QueuedTask> ParseQueue(std::string_view text, const ClusterJob& job);

// Removes what waits; what runs sees the job's cancel file, writes its state and ends.
Result<void> CancelInSlurm(const ClusterJob& job);
// Lets requeued tasks begin at once: Slurm would make them wait two minutes.
Result<void> ReleaseInSlurm(const ClusterJob& job);

}  // namespace lf
