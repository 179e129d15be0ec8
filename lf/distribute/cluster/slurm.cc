// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lf/core/child_process.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/core/shell_word.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kPatience_s = 60;  // timeout of a Slurm command: a busy slurmctld answers slowly

// Returns the error output of a program as one line; if it is empty, its standard output.
std::string Complaints(const CommandAnswer& answer) {
  std::string words = answer.complaints.empty() ? answer.output : answer.complaints;
  constexpr size_t kShown = 2000;
  words.resize(std::min(words.size(), kShown));
  while (!words.empty() && std::isspace(static_cast<unsigned char>(words.back()))) words.pop_back();
  std::replace(words.begin(), words.end(), '\n', ';');
  return words;
}

Result<std::string> Ask(const std::vector<std::string>& words) {
  const Result<CommandAnswer> answer = RunCommand(words, kPatience_s);
  if (!answer)
    return OutputError(answer.error().message +
                       "; {engine slurm} needs Slurm's programs (Debian: apt-get install "
                       "slurm-client), on a machine from which jobs may be submitted");
  if (answer->exit_code != 0)
    return OutputError(fmt::format("{} failed with exit code {}: {}", words.front(),
                                   answer->exit_code, Complaints(*answer)));
  return answer->output;
}

std::string TimeText(double seconds) {
  const auto minutes = static_cast<int64_t>(std::ceil(seconds / 60));
  return fmt::format("{}:{:02}:00", minutes / 60, minutes % 60);
}

// Returns the lines that both batch scripts begin with.
std::string Head(const ClusterJob& job, const char* name) {
  const std::string folder = job.output_folder.filename().string();
  std::string text = fmt::format(
      "#!/bin/bash\n"
      "#SBATCH --job-name={}\n"
      "#SBATCH --output={}\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --nodes=1 --ntasks=1 --cpus-per-task={}\n",
      ShellWord("lf-" + (folder.empty() ? "film" : folder)),
      ShellWord((job.Folder() / fmt::format("slurm-{}.out", name)).string()), job.thread_count);
  // Slurm's limit is the memory limit of lfrenderer plus a margin for the other processes of the
  // task.
  if (job.memory_bytes > 0)
    text += fmt::format("#SBATCH --mem={}M\n", (job.memory_bytes >> 20) + 256);
  if (job.time_limit_s > 0) text += fmt::format("#SBATCH --time={}\n", TimeText(job.time_limit_s));
  return text;
}

std::string UserOptions(const ClusterJob& job) {
  std::string text;
  for (const std::string& option : job.sbatch_options) text += "#SBATCH " + option + "\n";
  return text;
}

// Returns the job id of sbatch's output, which is "123" or "123;cluster".
Result<std::string> JobId(const std::string& answer) {
  constexpr size_t kMostDigits = 10, kShown = 80;  // Slurm's job ids have 32 bits
  const std::string id = answer.substr(0, answer.find_first_not_of("0123456789"));
  if (id.empty() || id.size() > kMostDigits)
    return OutputError(
        fmt::format("sbatch: printed \"{}\", expected the number of the submitted job",
                    answer.substr(0, kShown)));
  return id;
}

std::string OneOf(std::string_view* line) {
  const std::string word(line->substr(0, line->find('|')));
  line->remove_prefix(std::min(line->size(), word.size() + 1));
  return word;
}

std::string AllIds(const ClusterJob& job) {
  std::vector<std::string> ids = job.slurm_array_ids;
  if (!job.slurm_finishing_id.empty()) ids.push_back(job.slurm_finishing_id);
  return fmt::format("{}", fmt::join(ids, ","));
}

}  // namespace

std::string PackagesScript(const ClusterJob& job) {
  const std::string cancelled = ShellWord(job.CancelFile().string());
  std::string text =
      Head(job, "packages-%a") +
      "# Slurm may requeue a task if its node dies or is needed for other jobs.\n"
      "#SBATCH --requeue\n"
      "# SIGTERM arrives 120 s before the time limit, so that lfrenderer can write its state.\n"
      "#SBATCH --signal=B:TERM@120\n" +
      UserOptions(job) +
      fmt::format(
          "# Made by lfsubmit. Each task renders one package, from its checkpoint if there is one. "
          "To submit all:\n"
          "# sbatch --array={} {}\n"
          "\n"
          "if [[ ! $SLURM_ARRAY_TASK_ID ]]; then\n"
          "  echo 'error: SLURM_ARRAY_TASK_ID, the number of the package, is empty: submit this "
          "script as an array' >&2\n"
          "  exit 2\n"
          "fi\n"
          "is_ending=\n"
          "trap 'is_ending=1; kill -TERM $task' TERM\n"
          "for start in {{1..10}}; do\n"
          "  {} --run-package \"$SLURM_ARRAY_TASK_ID\" {}{} &\n"
          "  task=$!\n"
          "  wait $task\n"
          "  code=$?\n"
          "  while kill -0 $task 2>/dev/null; do  # a signal ended the wait, not the task\n"
          "    wait $task\n"
          "    code=$?\n"
          "  done\n"
          "  [[ $code -gt 128 && ! $is_ending ]] || break  # lfsubmit was killed: start it again\n"
          "done\n"
          "\n"
          "# A task that was interrupted (time limit, other jobs) is requeued, unless the job\n"
          "# was cancelled or the task was removed from the queue.\n"
          "me=${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID\n"
          "if [[ $code == 5 || $is_ending ]] && [[ $code != 0 && ! -e {} ]] &&\n"
          "   [[ $(squeue -h -j \"$me\" -o %T) == RUNNING ]]; then\n"
          "  scontrol requeue \"$me\"\n"
          "fi\n"
          "exit $code\n",
          fmt::format("0-{}", job.packages.size() - 1),
          ShellWord((job.Folder() / "packages.sbatch").string()), ShellWord(job.submitter.string()),
          ShellWord(job.output_folder.string()), RendererOptionText(job), cancelled);
  return text;
}

std::string FinishingScript(const ClusterJob& job) {
  return Head(job, "finish") + "#SBATCH --requeue\n" + UserOptions(job) +
         fmt::format(
             "# Made by lfsubmit. Runs after all packages: checks that all frames exist, then "
             "writes the\n"
             "# contact sheet and the video. Fails if frames are missing, and names them.\n"
             "\n"
             "exec {} --run-finish {}{}\n",
             ShellWord(job.submitter.string()), ShellWord(job.output_folder.string()),
             RendererOptionText(job));
}

std::string ArrayText(const std::vector<size_t>& numbers) {
  std::string text;
  for (size_t begin = 0, end = 0; begin < numbers.size(); begin = end) {
    for (end = begin + 1; end < numbers.size(); ++end)
      if (numbers[end] != numbers[end - 1] + 1) break;
    if (!text.empty()) text += ',';
    text += fmt::format("{}", numbers[begin]);
    if (end - begin > 1) text += fmt::format("-{}", numbers[end - 1]);
  }
  return text;
}

Result<void> SubmitToSlurm(ClusterJob* job, const std::vector<size_t>& numbers) {
  const fs::path packages = job->Folder() / "packages.sbatch",
                 finish = job->Folder() / "finish.sbatch";
  // A line break in a path would end a comment or #SBATCH line, even inside quotes.
  for (const fs::path& path : {job->output_folder, job->submitter, job->renderer})
    if (const std::string text = path.string(); OneLine(text) != text)
      return UsageError(fmt::format(
          "{}: contains a line break or another control character, which batch scripts of "
          "Slurm cannot contain: give the folder another name",
          text));
  LF_RETURN_IF_ERROR(WriteFileAtomically(packages, PackagesScript(*job)));
  LF_RETURN_IF_ERROR(WriteFileAtomically(finish, FinishingScript(*job)));
  if (!numbers.empty()) {
    std::string array = ArrayText(numbers);
    if (job->at_once > 0) array += fmt::format("%{}", job->at_once);
    const Result<std::string> answer =
        Ask({"sbatch", "--parsable", "--array=" + array, packages.string()});
    std::error_code ignored;
    if (!answer && job->slurm_array_ids.empty()) fs::remove(job->File(), ignored);
    if (!answer && answer.error().message.find("array") != std::string::npos)
      return OutputError(fmt::format(
          "{} (the packages are the tasks {} of a job array; their numbers must be less than "
          "MaxArraySize, which scontrol show config prints: make fewer packages)",
          answer.error().message, array));
    if (!answer)
      return OutputError(
          answer.error().message +
          " (if a task asks for too much, change {threads}, {memory}, {time_limit} or "
          "{sbatch})");
    LF_ASSIGN_OR_RETURN(std::string id, JobId(*answer));
    job->slurm_array_ids.push_back(std::move(id));
    LF_RETURN_IF_ERROR(WriteJob(*job));
  }
  if (!job->slurm_finishing_id.empty()) {
    // Errors are not checked, because the task may no longer exist.
    const auto ignored = RunCommand({"scancel", "--quiet", job->slurm_finishing_id}, kPatience_s);
    if (!ignored) LogWarning("{}", ignored.error().message);
    job->slurm_finishing_id.clear();
  }
  std::vector<std::string> words = {"sbatch", "--parsable"};
  if (!job->slurm_array_ids.empty())
    words.push_back(fmt::format("--dependency=afterany:{}", fmt::join(job->slurm_array_ids, ":")));
  words.push_back(finish.string());
  Result<std::string> finishing = Ask(words);
  if (finishing) finishing = JobId(*finishing);
  if (!finishing) {
    if (const auto removed = CancelInSlurm(*job); !removed)
      LogWarning("{}", removed.error().message);
    return finishing.error();
  }
  job->slurm_finishing_id = *finishing;
  return WriteJob(*job);
}

std::vector<QueuedTask> ParseQueue(std::string_view text, const ClusterJob& job) {
  std::vector<QueuedTask> tasks;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::string id = OneOf(&line), index = OneOf(&line);
    QueuedTask task;
    task.state = OneOf(&line);
    task.node = OneOf(&line);
    task.reason = OneOf(&line);
    task.is_finishing = !id.empty() && id == job.slurm_finishing_id;
    if (!task.is_finishing) {
      const auto known = std::find(job.slurm_array_ids.begin(), job.slurm_array_ids.end(), id);
      const auto number = ParseWhole<size_t>(index);
      if (known == job.slurm_array_ids.end() || !number || *number >= job.packages.size()) continue;
      task.number = *number;
    }
    tasks.push_back(std::move(task));
  }
  return tasks;
}

Result<std::vector<QueuedTask>> AskSlurm(const ClusterJob& job) {
  if (job.slurm_array_ids.empty() && job.slurm_finishing_id.empty())
    return std::vector<QueuedTask>();
  const std::vector<std::string> words = {"squeue", "--noheader", "--array",
                                          "--jobs=" + AllIds(job), "--format=%F|%K|%T|%N|%r"};
  const Result<CommandAnswer> answer = RunCommand(words, kPatience_s);
  if (!answer) return answer.error();
  // squeue fails if its only argument is a job that Slurm has forgotten.
  if (answer->exit_code != 0 && answer->complaints.find("Invalid job id") != std::string::npos)
    return std::vector<QueuedTask>();
  if (answer->exit_code != 0)
    return OutputError(
        fmt::format("squeue failed with exit code {}: {}", answer->exit_code, Complaints(*answer)));
  return ParseQueue(answer->output, job);
}

Result<void> CancelInSlurm(const ClusterJob& job) {
  std::vector<std::string> words = {"scancel", "--quiet", "--state=PENDING"};
  words.insert(words.end(), job.slurm_array_ids.begin(), job.slurm_array_ids.end());
  if (!job.slurm_finishing_id.empty()) words.push_back(job.slurm_finishing_id);
  if (words.size() == 3) return {};
  const Result<CommandAnswer> answer = RunCommand(words, kPatience_s);
  if (!answer) return answer.error();
  // If there are no waiting tasks, scancel fails without a message.
  if (answer->exit_code != 0 && !Complaints(*answer).empty())
    return OutputError(fmt::format("scancel failed with exit code {}: {}", answer->exit_code,
                                   Complaints(*answer)));
  return {};
}

Result<void> ReleaseInSlurm(const ClusterJob& job) {
  LF_ASSIGN_OR_RETURN(const std::vector<QueuedTask> tasks, AskSlurm(job));
  for (const QueuedTask& task : tasks) {
    if (task.state != "PENDING" || task.reason != "BeginTime" || task.is_finishing) continue;
    for (const std::string& id : job.slurm_array_ids) {
      const auto ignored = RunCommand(
          {"scontrol", "update", fmt::format("jobid={}_{}", id, task.number), "StartTime=now"},
          kPatience_s);
      if (!ignored) return ignored.error();
    }
  }
  return {};
}

}  // namespace lf
