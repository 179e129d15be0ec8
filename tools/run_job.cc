// SPDX-License-Identifier: Apache-2.0
#include "tools/run_job.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "tools/common/interrupt.h"
#include "tools/common/progress.h"

#include "lf/core/byte_text.h"
#include "lf/core/log.h"
#include "lf/core/shell_word.h"
#include "lf/distribute/cluster/farm_files.h"
#include "lf/distribute/cluster/job_status.h"
#include "lf/distribute/cluster/job_table.h"
#include "lf/distribute/cluster/resume_job.h"
#include "lf/distribute/cluster/run_locally.h"
#include "lf/distribute/cluster/slurm.h"
#include "lf/distribute/cluster/task_state.h"

namespace lf {
namespace {

std::string PackagesText(size_t count) {
  return fmt::format("{} package{}", count, count == 1 ? "" : "s");
}

void Show(const ClusterJob& job, ProgressMeter& meter) {
  const JobStatus status = LookAtJob(job);
  meter.Update(status.rays_done(), status.ray_total(), JobSummary(status));
}

Result<void> WriteForFarm(const ClusterJob& job, const std::vector<size_t>& numbers,
                          const std::string& write) {
  const std::string status = JobCommand("--status", job.output_folder);
  const auto to = write.empty() ? job.Folder() / NameOf(job.engine) : std::filesystem::path(write);
  LF_ASSIGN_OR_RETURN(const std::filesystem::path file, WriteFarmFiles(job, numbers, to));
  if (job.engine == ClusterEngine::kOpenJd)
    LogInfo(
        "{}: written, for {}; submit its folder, for example with deadline bundle submit {}; to "
        "see the progress: {}",
        file.string(), PackagesText(numbers.size()), ShellWord(to.string()), status);
  else
    LogInfo(
        "{}: written; its first lines say how to submit it as an array of {} task{}, and "
        "finish.sh makes the video when all have ended; to see the progress: {}",
        file.string(), job.packages.size(), job.packages.size() == 1 ? "" : "s", status);
  return {};
}

}  // namespace

Result<void> RunJob(ClusterJob job, FileLock lock, const std::vector<size_t>& numbers,
                    const RunJobOptions& options, const CommonOptions& common) {
  if (IsForFarm(job)) return WriteForFarm(job, numbers, options.write);
  std::optional<FileLock> held = std::move(lock);
  const std::string see = JobCommand("--status", job.output_folder);
  const auto& stop = CatchInterruptsOfJob();
  ProgressMeter meter(ParseProgressStyle(common.progress), "rays");
  Result<void> outcome;
  if (job.engine == ClusterEngine::kLocal) {
    if (!numbers.empty())
      LogInfo("{}, {} at a time, {} thread{} and {} each; to see the progress: {}",
              PackagesText(numbers.size()), job.at_once, job.thread_count,
              job.thread_count == 1 ? "" : "s", ByteText(job.memory_bytes), see);
    outcome = RunLocally(job, *held, numbers, stop, [&] { Show(job, meter); });
  } else {
    LF_RETURN_IF_ERROR(SubmitToSlurm(&job, numbers));
    held.reset();  // Slurm runs the job now; other programs may resume or cancel it
    LogInfo("submitted {} (array {}) and finishing task {}; to see the progress: {}",
            PackagesText(numbers.size()), numbers.empty() ? "-" : job.slurm_array_ids.back(),
            job.slurm_finishing_id, see);
    if (!options.waits) return {};
    outcome = WaitForJob(job, stop, [&] { Show(job, meter); });
  }
  if (!outcome && outcome.error().kind != ErrorKind::kBelowRequired) return outcome.error();
  // Shows what lfrenderer reported about the whole film: rays, warnings, where to look. Its error
  // is left out here, because it is returned as `outcome`.
  for (const std::string& line : LinesOfLastStart(FinishingTask(job).log))
    if (!line.starts_with("error: ")) LogInfo("{}", line);
  if (common.json) LF_RETURN_IF_ERROR(PrintReport(ToJson(job, LookAtJob(job))));
  return outcome;
}

}  // namespace lf
