// SPDX-License-Identifier: Apache-2.0
// lfsubmit PACKAGES... -o DIR: renders the packages of a film with many processes or machines.
#include <fmt/format.h>

#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/run_job.h"
#include "tools/submit_arguments.h"

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/distribute/cluster/finish_frames.h"
#include "lf/distribute/cluster/job_status.h"
#include "lf/distribute/cluster/job_table.h"
#include "lf/distribute/cluster/resume_job.h"
#include "lf/distribute/cluster/run_locally.h"
#include "lf/distribute/cluster/run_package.h"
#include "lf/distribute/cluster/slurm.h"
#include "lf/distribute/cluster/task_state.h"
#include "lf/film/develop/video.h"

namespace {
constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfsubmit"),
    .usage = R"(  lfsubmit PACKAGE... -o DIR [OPTIONS] [-- OPTIONS OF lfrenderer]
  lfsubmit --status DIR | --cancel DIR | --resume DIR | --finish DIR FRAMES)",
    .examples = R"(  lfpreprocessor capture/ path.yaml -o packages --packages 8
  lfsubmit packages/*.lfp -o film --jobs 2 --video film.mp4              # on this machine
  lfsubmit packages/*.lfp -o film --engine slurm --threads 8 --time-limit 2h
  lfsubmit packages/*.lfp -o film --engine slurm --sbatch=--partition=long
  lfsubmit packages/*.lfp -o film --engine openjd --write bundle         # for AWS Deadline Cloud
  lfsubmit packages/*.lfp -o film --engine array --write scripts         # for any batch system
  lfsubmit packages/*.lfp -o film -- --format png16 --lens-weights area  # options of lfrenderer
  lfsubmit --status film
  lfsubmit --finish film 10-20     # finish these frames as they are now
  lfsubmit --cancel film           # or Ctrl-C, if the job runs here
  lfsubmit --resume film)",
    .details =
        R"(Each package is rendered by its own lfrenderer process. A process that is interrupted or dies is
restarted and resumes from its checkpoint. Frames are bit-identical to those of a single lfrenderer
run. DIR/partial contains pictures of unfinished frames. DIR/cluster contains the job: batch
scripts, and the state and the log of each package.

If a package fails, the others continue. The exit code is 0 if every frame was written; otherwise it
is that of the first package that failed, and the last line names the missing frames. It is 6 if
every frame was written, but LF images were left out because they are missing or broken. The last
line then says how many in which packages; to accept them, add "-- --allow-missing N". See
doc/cluster.md.)",
    .rest_program = "lfrenderer",
    .refused_in_rest = lf::kRefusedAfterDashes,
};

using lf::ClusterJob;
using lf::Result;

Result<void> Submit(const lf::SubmitArguments& arguments, const lf::CommonOptions& common) {
  LF_ASSIGN_OR_RETURN(const ClusterJob job, arguments.MakeJob(common));
  if (job.packages.empty()) {
    arguments.frames.TellNone();
    return common.json ? lf::PrintReport(lf::ToJson(job, lf::JobStatus())) : Result<void>();
  }
  if (job.video) {
    LF_RETURN_IF_ERROR(lf::CheckVideoTool());
    LF_RETURN_IF_ERROR(lf::CreateFolder(job.output_folder));
    LF_RETURN_IF_ERROR(lf::CheckVideoTarget(*job.video));
  }
  LF_ASSIGN_OR_RETURN(lf::FileLock lock, lf::TakeJob(job));
  LF_RETURN_IF_ERROR(lf::MakeRoomForJob(job, arguments.overwrite));
  LF_RETURN_IF_ERROR(lf::WriteJob(job));
  std::vector<size_t> numbers(job.packages.size());
  std::iota(numbers.begin(), numbers.end(), size_t{0});
  return lf::RunJob(job, std::move(lock), numbers, {arguments.wait, arguments.write}, common);
}

Result<void> Resume(const lf::SubmitArguments& arguments, const lf::CommonOptions& common) {
  LF_ASSIGN_OR_RETURN(ClusterJob job, arguments.ReadJobToRun(arguments.resume));
  LF_ASSIGN_OR_RETURN(lf::FileLock lock, lf::TakeJob(job));
  // Another program may have changed the job before we got the lock.
  LF_ASSIGN_OR_RETURN(job, arguments.ReadJobToRun(arguments.resume));
  LF_RETURN_IF_ERROR(arguments.Change(&job, common));
  const lf::JobStatus status = lf::LookAtJob(job);
  if (status.phase == lf::TaskPhase::kDone && arguments.video.empty() && !common.strict &&
      !arguments.HasRendererArguments()) {
    lf::LogInfo("{}: the film is done", job.output_folder.string());
    return lf::OutcomeOf("the film", status.finishing.state);
  }
  LF_ASSIGN_OR_RETURN(const std::vector<size_t> numbers, lf::PrepareResume(job));
  return lf::RunJob(job, std::move(lock), numbers, {arguments.wait, arguments.write}, common);
}

Result<void> Finish(const std::string& folder, const std::string& frames) {
  LF_ASSIGN_OR_RETURN(const ClusterJob job, lf::ReadJob(folder));
  LF_ASSIGN_OR_RETURN(const size_t count, lf::AskToFinish(job, frames));
  lf::LogInfo(
      "{} unfinished frames will be finished with the rays that they have, within seconds if their "
      "packages are running; report-*.json state how far each got in the order of the LF images "
      "(finished_early_before_rank)",
      count);
  return {};
}

// Parses the number of a package, which a batch system states as the index of the task.
Result<size_t> NumberOfPackage(const std::string& text, const ClusterJob& job) {
  const std::optional<size_t> number = lf::ParseWhole<size_t>(text);
  // "00" is refused: if two tasks state one package in two ways, a package is left out.
  if (number && *number < job.packages.size() && fmt::format("{}", *number) == text) return *number;
  return lf::UsageError(fmt::format(
      "--run-package {}: expected the number of a package, 0 to {}{}", text.empty() ? "''" : text,
      job.packages.size() - 1,
      text.empty() ? ", found nothing: is the variable unset in which the batch system states the "
                     "index of a task, such as SLURM_ARRAY_TASK_ID?"
                   : ""));
}

Result<void> Act(const lf::SubmitArguments& arguments, const lf::CommonOptions& common) {
  LF_RETURN_IF_ERROR(arguments.Check());
  if (!arguments.status.empty()) {
    LF_ASSIGN_OR_RETURN(const ClusterJob job, lf::ReadJob(arguments.status));
    const lf::JobStatus status = lf::LookAtJob(job);
    return lf::PrintReport(common.json ? lf::ToJson(job, status) : lf::JobTable(job, status));
  }
  if (!arguments.cancel.empty()) {
    LF_ASSIGN_OR_RETURN(const ClusterJob job, lf::ReadJob(arguments.cancel));
    LF_RETURN_IF_ERROR(lf::CancelJob(job, lf::CatchInterruptsOfJob()));
    return common.json ? lf::PrintReport(lf::ToJson(job, lf::LookAtJob(job))) : Result<void>();
  }
  if (!arguments.resume.empty()) return Resume(arguments, common);
  if (!arguments.finish.empty()) return Finish(arguments.finish[0], arguments.finish[1]);
  if (!arguments.run_finish.empty()) {
    LF_ASSIGN_OR_RETURN(const ClusterJob job, arguments.ReadJobToRun(arguments.run_finish));
    return lf::FinishFilm(job, lf::NodeName(), lf::CatchInterruptsOfJob());
  }
  if (!arguments.run_package.empty()) {
    LF_ASSIGN_OR_RETURN(const ClusterJob job, arguments.ReadJobToRun(arguments.run_package[1]));
    LF_ASSIGN_OR_RETURN(const size_t number, NumberOfPackage(arguments.run_package[0], job));
    // Batch systems keep what a task prints. Only farms that ask for progress get it.
    lf::ProgressMeter meter(common.progress == "auto" ? lf::ProgressStyle::kNone
                                                      : lf::ParseProgressStyle(common.progress),
                            "px");
    const auto look = [&, log = lf::PackageTask(job, number).log] {
      const lf::TaskProgress now = lf::ReadProgress(log);
      meter.Update(now.done, now.total, {{"LF image", now.image_done, now.image_total}});
    };
    LF_ASSIGN_OR_RETURN(
        const lf::TaskState state,
        lf::RunPackage(job, number, lf::NodeName(), lf::CatchInterruptsOfJob(), look));
    const Result<void> outcome = lf::OutcomeOf(job.packages[number].name, state);
    if (state.phase != lf::TaskPhase::kDone || outcome) return outcome;
    // The package is done, but not as required. Slurm must see it as done, because the finishing
    // task judges the whole film.
    lf::LogWarning("{}", outcome.error().message);
    return {};
  }
  return Submit(arguments, common);
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfsubmit", kHelp);
  lf::SubmitArguments arguments;
  arguments.AddTo(program.app());
  program.AddCommonOptions({.threads = true,
                            .strict =
                                "Passed to lfrenderer: stop at a missing or broken LF image\n"
                                "Without this option a missing or broken LF image is left out.",
                            .json = "Print the status to stdout as JSON",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc, argv, [&] { return Act(arguments, program.common()); });
}
