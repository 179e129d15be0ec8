// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/farm_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/shell_word.h"
#include "lf/distribute/cluster/slurm.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostPathBytes = 1024;  // length limit of job parameters in Open Job Description

// Returns a text in double quotes, as YAML and JSON read it. CheckFarmPaths() has checked that it
// is UTF-8.
std::string Quoted(const std::string& text) { return RecordLine(text); }

// Returns the words of RendererOption() for a list of arguments of a template, each after a comma.
std::string RendererTemplateWords(const ClusterJob& job) {
  std::string text;
  for (const std::string& word : RendererOption(job)) text += ", " + Quoted(word);
  return text;
}

std::string JobName(const ClusterJob& job) {
  constexpr size_t kMostBytes = 100;
  const std::string folder = job.output_folder.filename().string();
  return "lf-" + (folder.empty() ? "film" : folder).substr(0, kMostBytes);
}

}  // namespace

Result<void> CheckFarmPaths(const ClusterJob& job) {
  for (const fs::path& path : {job.output_folder, job.submitter, job.renderer}) {
    const std::string text = path.string();
    if (job.engine == ClusterEngine::kOpenJd && !IsUtf8(text))
      return UsageError(fmt::format(
          "{}: is not UTF-8, as the job template of Open Job Description must be: give the folder "
          "another name, or use {{engine array}}",
          text));
    const bool is_expression =
        job.engine == ClusterEngine::kOpenJd && text.find("{{") != std::string::npos;
    if (OneLine(text) != text || is_expression || text.size() > kMostPathBytes)
      return UsageError(fmt::format(
          "{}: contains a control character or {{{{, or is longer than {} bytes, which files for "
          "farms cannot contain: give the folder another name",
          text, kMostPathBytes));
  }
  return {};
}

namespace {

constexpr const char* kParameters = R"(parameterDefinitions:
- name: JobFolder
  type: PATH
  objectType: DIRECTORY
  dataFlow: NONE
  default: {}
  description: Folder of the frames and of the job. All workers see it under this path.
- name: Lfsubmit
  type: PATH
  objectType: FILE
  dataFlow: NONE
  default: {}
  description: Program that renders a package.
)";

constexpr const char* kPackagesStep = R"(- name: Packages
  parameterSpace:
    taskParameterDefinitions:
    - name: Package
      type: INT
      range: {}
  hostRequirements:
    amounts:
    - name: amount.worker.vcpu
      min: {}
    - name: amount.worker.memory
      min: {}
  script:
    actions:
      onRun:
        command: "{{{{Param.Lfsubmit}}}}"
        args: [--run-package, "{{{{Task.Param.Package}}}}", "{{{{Param.JobFolder}}}}", --progress, openjd{}]
        # SIGTERM makes lfrenderer write its checkpoint; SIGKILL would lose the work since the last one.
        cancelation:
          mode: NOTIFY_THEN_TERMINATE
          notifyPeriodInSeconds: 120
)";

constexpr const char* kFilmStep = R"(- name: Film
{}  script:
    actions:
      onRun:
        command: bash
        args: ["{{{{Task.File.Finish}}}}", "{{{{Param.Lfsubmit}}}}", "{{{{Param.JobFolder}}}}"{}]
        cancelation:
          mode: NOTIFY_THEN_TERMINATE
          notifyPeriodInSeconds: 120
    embeddedFiles:
    - name: Finish
      type: TEXT
      runnable: true
      data: |
        #!/bin/bash
        # Checks that all frames exist, and makes contact sheet and video.
        trap 'kill -TERM $task' TERM
        "$1" --run-finish "${{@:2}}" --progress openjd &
        task=$!
        wait $task
        code=$?
        while kill -0 $task 2>/dev/null; do  # a signal ended the wait, not the task
          wait $task
          code=$?
        done
        # Exit code 6: the film is done, but LF images were left out or frames are not as required.
        if [[ $code == 6 ]]; then
          echo "openjd_status: the film is done, with faults that the log names"
          exit 0
        fi
        exit $code
)";

constexpr const char* kArrayScript = R"(#!/bin/bash
#$ -S /bin/bash
# Made by lfsubmit. Each task of an array renders one package, from its checkpoint if there is one. Packages
# are numbered from 0 to {last}; Grid Engine and LSF number tasks from 1.
#   Slurm          sbatch --array=0-{last} --signal=B:TERM@120 {script}
#   PBS Pro        qsub -J 0-{last} {script}
#   Torque         qsub -t 0-{last} {script}
#   Grid Engine    qsub -t 1-{count} -notify {script}
#   LSF            bsub -J "lf[1-{count}]" {script}
#   HTCondor       executable = {script}; arguments = $(Process); queue {count}
#   Kubernetes     completionMode: Indexed; completions: {count}
#   AWS Batch      arrayProperties: size {count}
#   by hand        {script} NUMBER

if [[ $# -gt 0 ]]; then
  number=$1
elif [[ $SLURM_ARRAY_TASK_ID ]]; then
  number=$SLURM_ARRAY_TASK_ID
elif [[ $PBS_ARRAY_INDEX ]]; then  # PBS Pro
  number=$PBS_ARRAY_INDEX
elif [[ $PBS_ARRAYID ]]; then  # Torque
  number=$PBS_ARRAYID
elif [[ $SGE_TASK_ID && $SGE_TASK_ID != undefined ]]; then
  number=$((SGE_TASK_ID - 1))
elif [[ $LSB_JOBINDEX && $LSB_JOBINDEX != 0 ]]; then
  number=$((LSB_JOBINDEX - 1))
elif [[ $JOB_COMPLETION_INDEX ]]; then  # Kubernetes
  number=$JOB_COMPLETION_INDEX
elif [[ $AWS_BATCH_JOB_ARRAY_INDEX ]]; then
  number=$AWS_BATCH_JOB_ARRAY_INDEX
elif [[ -r $_CONDOR_JOB_AD ]]; then
  number=$(sed -n 's/^ProcId *= *//p' "$_CONDOR_JOB_AD")
fi
if [[ ! $number ]]; then
  echo "error: no number of a package is given: submit this script as an array, or give a number as its argument" >&2
  exit 2
fi

# Schedulers announce the end of a task by different signals, some of them to all processes of the task. Only
# SIGTERM makes lfsubmit write its state; the others must not end it.
trap 'kill -TERM $task' TERM INT USR1 USR2 XCPU
(trap '' USR1 USR2 XCPU; exec {submitter} --run-package "$number" {folder}{renderer}) &
task=$!
wait $task
code=$?
while kill -0 $task 2>/dev/null; do  # a signal ended the wait, not the task
  wait $task
  code=$?
done
exit $code
)";

constexpr const char* kArrayFinishingScript = R"(#!/bin/bash
#$ -S /bin/bash
# Made by lfsubmit. To be run when all packages have ended: checks that all frames exist, then makes contact
# sheet and video. Fails if frames are missing, and names them.

exec {} --run-finish {}{}
)";

}  // namespace

std::string OpenJdTemplate(const ClusterJob& job, const std::vector<size_t>& numbers) {
  std::string text = fmt::format(
      "# Made by lfsubmit (--engine openjd).\nspecificationVersion: jobtemplate-2023-09\nname: "
      "{}\n",
      Quoted(JobName(job)));
  text +=
      fmt::format(kParameters, Quoted(job.output_folder.string()), Quoted(job.submitter.string()));
  text += "steps:\n";
  // The worker needs a margin for processes other than lfrenderer.
  const uint64_t memory_mib = (job.memory_bytes >> 20) + 256;
  if (!numbers.empty())
    text += fmt::format(kPackagesStep, Quoted(ArrayText(numbers)), std::max(job.thread_count, 1),
                        memory_mib, RendererTemplateWords(job));
  text +=
      fmt::format(kFilmStep, numbers.empty() ? "" : "  dependencies:\n  - dependsOn: Packages\n",
                  RendererTemplateWords(job));
  return text;
}

std::string ArrayScript(const ClusterJob& job) {
  return fmt::format(kArrayScript, fmt::arg("last", job.packages.size() - 1),
                     fmt::arg("count", job.packages.size()), fmt::arg("script", "packages.sh"),
                     fmt::arg("submitter", ShellWord(job.submitter.string())),
                     fmt::arg("folder", ShellWord(job.output_folder.string())),
                     fmt::arg("renderer", RendererOptionText(job)));
}

std::string ArrayFinishingScript(const ClusterJob& job) {
  return fmt::format(kArrayFinishingScript, ShellWord(job.submitter.string()),
                     ShellWord(job.output_folder.string()), RendererOptionText(job));
}

Result<fs::path> WriteFarmFiles(const ClusterJob& job, const std::vector<size_t>& numbers,
                                const fs::path& folder) {
  LF_RETURN_IF_ERROR(CheckFarmPaths(job));
  LF_RETURN_IF_ERROR(CreateFolder(folder));
  if (job.engine == ClusterEngine::kOpenJd) {
    LF_RETURN_IF_ERROR(WriteFileAtomically(folder / "template.yaml", OpenJdTemplate(job, numbers)));
    return folder / "template.yaml";
  }
  const fs::path packages = folder / "packages.sh", finish = folder / "finish.sh";
  LF_RETURN_IF_ERROR(WriteFileAtomically(packages, ArrayScript(job)));
  LF_RETURN_IF_ERROR(WriteFileAtomically(finish, ArrayFinishingScript(job)));
  for (const fs::path& script : {packages, finish}) {
    std::error_code error;
    fs::permissions(script, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                    fs::perm_options::add, error);
    if (error)
      return OutputError(
          fmt::format("{}: cannot be made executable: {}", script.string(), error.message()));
  }
  return packages;
}

}  // namespace lf
