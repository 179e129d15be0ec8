// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/job.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "lf/core/file.h"
#include "lf/core/ids.h"
#include "lf/core/shell_word.h"
#include "lf/core/value_named.h"
#include "lf/render/pipeline/frame_range.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kJobLimit_bytes = size_t{64} << 20;
constexpr const char* kJobFormat = "lfjob 1";
constexpr size_t kMostFramesOfJob = 10'000'000;  // largest number of frames of all packages

// Returns true if the text contains control characters, such as line breaks, which would start a
// new line in a batch script.
bool HasControls(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

bool IsNumber(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Checks the options of sbatch and the job ids, which are written into batch scripts and commands
// of Slurm, and the frame extension. Returns a description of the first fault; empty if there is
// none.
std::string FaultOf(const ClusterJob& job) {
  for (const std::string& option : job.sbatch_options)
    if (HasControls(option) || !option.starts_with('-'))
      return fmt::format("\"sbatch_options\": expected options of sbatch, found \"{}\"", option);
  for (const std::string& id : job.slurm_array_ids)
    if (!IsNumber(id))
      return fmt::format("\"slurm_arrays\": expected numbers of jobs, found \"{}\"", id);
  if (!job.slurm_finishing_id.empty() && !IsNumber(job.slurm_finishing_id))
    return fmt::format("\"slurm_finishing\": expected the number of a job, found \"{}\"",
                       job.slurm_finishing_id);
  if (!job.frame_extension.starts_with('.') || job.frame_extension.find('/') != std::string::npos)
    return fmt::format("\"frame_extension\": expected an extension such as .exr, found \"{}\"",
                       job.frame_extension);
  return "";
}

Json PackageToJson(const JobPackage& package) {
  return {{"file", NameToJson(package.file.string())},
          {"name", NameToJson(package.name)},
          {"frames", FrameRangeText(package.frames)},
          {"is_whole", package.is_whole},
          {"rays", package.ray_count}};
}

JobPackage PackageFromJson(const Json& json, std::string* fault) {
  RecordFields fields(json, fault);
  JobPackage package;
  std::string file, frames;
  fields.Get("file", &file);
  fields.Get("name", &package.name);
  fields.Get("frames", &frames);
  fields.Get("is_whole", &package.is_whole);
  fields.Get("rays", &package.ray_count);
  package.file = file;
  if (!fault->empty()) return package;
  const auto parsed = ParseFrameRange(frames, {0, size_t{kLargestFrameNumber} + 1}, "\"frames\"");
  if (!parsed)
    *fault = parsed.error().message;
  else if (FrameRangeText(*parsed) != frames)
    *fault = "\"frames\": expected ascending numbers and ranges without repeats";
  else
    package.frames = *parsed;
  // The name is checked because it becomes a part of file names.
  if (package.name.empty() || package.name.find('/') != std::string::npos ||
      package.name.front() == '.' || HasControls(package.name))
    *fault = fmt::format("\"name\": expected the name of a package, found \"{}\"", package.name);
  return package;
}

}  // namespace

const char* NameOf(ClusterEngine engine) {
  constexpr const char* kNames[] = {"local", "slurm", "openjd", "array"};
  return kNames[static_cast<int>(engine)];
}

std::optional<ClusterEngine> ClusterEngineOf(std::string_view name) {
  return ValueNamed(name, {ClusterEngine::kLocal, ClusterEngine::kSlurm, ClusterEngine::kOpenJd,
                           ClusterEngine::kArray});
}

bool ClusterJob::IsCancelled() const {
  std::error_code ignored;
  return fs::exists(CancelFile(), ignored);
}

std::vector<std::string> RendererOption(const ClusterJob& job) {
  if (job.renderer.empty() || job.renderer == job.submitter.parent_path() / "lfrenderer") return {};
  return {"--lfrenderer", job.renderer.string()};
}

std::string RendererOptionText(const ClusterJob& job) {
  std::string text;
  for (const std::string& word : RendererOption(job)) text += " " + ShellWord(word);
  return text;
}

std::string ResumeCommand(const ClusterJob& job) {
  return JobCommand("--resume", job.output_folder) + RendererOptionText(job);
}

ClusterTask PackageTask(const ClusterJob& job, size_t number) {
  const std::string& name = job.packages[number].name;
  const fs::path folder = job.Folder() / "packages";
  return {name, folder / (name + ".json"), folder / (name + ".log"), folder / (name + ".lock")};
}

ClusterTask FinishingTask(const ClusterJob& job) {
  const fs::path folder = job.Folder();
  return {"finish", folder / "finish.json", folder / "finish.log", folder / "finish.lock"};
}

std::string FrameRangeText(const std::vector<FrameId>& frames) {
  std::string text;
  for (size_t begin = 0, end = 0; begin < frames.size(); begin = end) {
    for (end = begin + 1; end < frames.size(); ++end)
      if (frames[end].value != frames[end - 1].value + 1) break;
    if (!text.empty()) text += ',';
    text += fmt::format("{}", frames[begin].value);
    if (end - begin > 1) text += fmt::format("-{}", frames[end - 1].value);
  }
  return text;
}

std::string ToJson(const ClusterJob& job) {
  Json packages = Json::array();
  for (const JobPackage& package : job.packages) packages.push_back(PackageToJson(package));
  Json arguments = Json::array();
  for (const std::string& argument : job.arguments) arguments.push_back(NameToJson(argument));
  const Json json = {{"format", kJobFormat},
                     {"output_folder", NameToJson(job.output_folder.string())},
                     {"working_folder", NameToJson(job.working_folder.string())},
                     {"arguments", std::move(arguments)},
                     {"frame_extension", job.frame_extension},
                     {"video", NameToJson(job.video ? job.video->string() : "")},
                     {"contact_sheet", job.contact_sheet},
                     {"engine", NameOf(job.engine)},
                     {"at_once", job.at_once},
                     {"threads", job.thread_count},
                     {"memory_bytes", job.memory_bytes},
                     {"most_crashes", job.most_crashes},
                     {"time_limit_s", job.time_limit_s},
                     {"sbatch_options", job.sbatch_options},
                     {"slurm_arrays", job.slurm_array_ids},
                     {"slurm_finishing", job.slurm_finishing_id},
                     {"packages", std::move(packages)}};
  return RecordText(json);
}

Result<ClusterJob> ParseJob(std::string_view text, const std::string& name) {
  std::string fault, engine, video, output, working;
  ClusterJob job;
  const Json json = ParseRecord(text, kJobFormat, &fault);
  if (fault.empty()) {
    RecordFields fields(json, &fault);
    fields.Get("output_folder", &output);
    fields.Get("working_folder", &working);
    fields.Get("arguments", &job.arguments);
    fields.Get("frame_extension", &job.frame_extension);
    fields.Get("video", &video);
    fields.Get("contact_sheet", &job.contact_sheet);
    fields.Get("engine", &engine);
    fields.Get("at_once", &job.at_once);
    fields.Get("threads", &job.thread_count);
    fields.Get("memory_bytes", &job.memory_bytes);
    fields.Get("most_crashes", &job.most_crashes);
    fields.Get("time_limit_s", &job.time_limit_s);
    fields.Get("sbatch_options", &job.sbatch_options);
    fields.Get("slurm_arrays", &job.slurm_array_ids);
    fields.Get("slurm_finishing", &job.slurm_finishing_id);
    size_t frame_count = 0;
    for (const Json* item : fields.List("packages")) {
      job.packages.push_back(PackageFromJson(*item, &fault));
      frame_count += job.packages.back().frames.size();
      if (fault.empty() && frame_count > kMostFramesOfJob)
        fault = fmt::format("\"packages\": expected at most {} frames in all packages together",
                            kMostFramesOfJob);
      if (!fault.empty()) break;
    }
    const auto known = ClusterEngineOf(engine);
    if (known) job.engine = *known;
    if (fault.empty() && !known)
      fault =
          fmt::format("\"engine\": expected local, slurm, openjd or array, found \"{}\"", engine);
    if (fault.empty() && job.packages.empty())
      fault = "\"packages\": expected at least one package, found none";
    if (fault.empty()) fault = FaultOf(job);
  }
  if (!fault.empty())
    return InputError(fmt::format(
        "{}: is not a job file of lfsubmit: {}; remove the file to submit a new job", name, fault));
  job.output_folder = output;
  job.working_folder = working;
  if (!video.empty()) job.video = video;
  return job;
}

Result<void> WriteJob(const ClusterJob& job) {
  LF_RETURN_IF_ERROR(CreateFolder(job.Folder() / "packages"));
  return WriteFileAtomically(job.File(), ToJson(job));
}

Result<void> CheckMayRun(const ClusterJob& job) {
  struct stat status {};
  if (::stat(job.File().c_str(), &status) != 0)
    return InputError(
        fmt::format("{}: cannot be read: {}", job.File().string(), std::strerror(errno)));
  if (status.st_uid == ::geteuid() || status.st_uid == 0) return {};
  return UsageError(fmt::format(
      "{}: belongs to the user with id {}; lfrenderer would run with your rights and with the "
      "options that this file names: submit the packages again, into a folder of your own",
      job.File().string(), status.st_uid));
}

Result<ClusterJob> ReadJob(const fs::path& output_folder) {
  const fs::path file = output_folder / "cluster" / "job.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    return InputError(fmt::format(
        "{}: contains no job (there is no cluster/job.json): give the DIR of an earlier lfsubmit "
        "PACKAGES... -o DIR",
        output_folder.string()));
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kJobLimit_bytes));
  LF_ASSIGN_OR_RETURN(ClusterJob job, ParseJob(text, file.string()));
  // The stored path is not used, because the folder may have been moved, or be mounted elsewhere on
  // this machine.
  job.output_folder = fs::absolute(output_folder);
  return job;
}

std::string JobCommand(const std::string& option, const fs::path& output_folder) {
  return ShellCommand({"lfsubmit", option, FileArgument(output_folder)});
}

}  // namespace lf
