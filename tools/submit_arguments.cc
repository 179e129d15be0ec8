// SPDX-License-Identifier: Apache-2.0
#include "tools/submit_arguments.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <thread>

#include "tools/common/frame_options.h"
#include "tools/common/help.h"
#include "tools/common/parse_errors.h"
#include "tools/common/validators.h"
#include "tools/render_arguments.h"

#include "lf/core/log.h"
#include "lf/core/quantities.h"
#include "lf/core/shell_word.h"
#include "lf/distribute/cluster/farm_files.h"
#include "lf/distribute/cluster/slurm.h"
#include "lf/render/package/package_file.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/pipeline/render_packages.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

uint64_t MachineMemoryBytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page_bytes = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page_bytes > 0
             ? static_cast<uint64_t>(pages) * static_cast<uint64_t>(page_bytes)
             : uint64_t{8} << 30;
}

// kUsage if the video of the job is another of its files, or one of its packages.
Result<void> CheckVideo(const ClusterJob& job) {
  std::vector<FrameId> frames;
  std::vector<std::string> names;
  std::vector<fs::path> packages;
  for (const JobPackage& package : job.packages) {
    frames.insert(frames.end(), package.frames.begin(), package.frames.end());
    names.push_back(package.name);
    packages.push_back(package.file);
  }
  const FrameFormat format =
      job.frame_extension == ".exr" ? FrameFormat::kExrHalf : FrameFormat::kPng8;
  LF_ASSIGN_OR_RETURN(const OutputFiles outputs,
                      MakeFilmOutputs(OutputsOfFilm(job.output_folder, frames, format, names),
                                      job.output_folder, job.video));
  return outputs.CheckReplacesNone(packages);
}

int MachineThreads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

// Returns the folder of this program, so that jobs use the programs that were installed with it.
Result<fs::path> ProgramFolder() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (error) return OutputError("/proc/self/exe: cannot be read: " + error.message());
  return self.parent_path();
}

Result<fs::path> FindRenderer(const std::string& asked_for) {
  LF_ASSIGN_OR_RETURN(const fs::path folder, ProgramFolder());
  const fs::path renderer = asked_for.empty() ? folder / "lfrenderer" : fs::absolute(asked_for);
  if (::access(renderer.c_str(), X_OK) != 0)
    return UsageError(fmt::format(
        "{}: cannot be executed; expected the program lfrenderer: give its path with --lfrenderer",
        renderer.string()));
  return renderer;
}

// Refuses the arguments of lfrenderer that lfsubmit itself decides on, and those that render
// nothing.
Result<void> CheckRendererArguments(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    const auto is = [&](const std::string& word) {
      return argument == word || argument.starts_with(word + "=");
    };
    if (std::any_of(kRefusedAfterDashes.begin() + kRenderNothingCount, kRefusedAfterDashes.end(),
                    is))
      return UsageError(fmt::format(
          "{}: cannot be given after --, because lfsubmit itself decides on this option of "
          "lfrenderer: leave it out, or give it to lfsubmit (before --), if lfsubmit has it",
          argument));
    if (std::any_of(kRefusedAfterDashes.begin(), kRefusedAfterDashes.begin() + kRenderNothingCount,
                    is))
      return UsageError(fmt::format(
          "{}: cannot be given after --, because lfrenderer would only print a text and render "
          "nothing: leave it out, or call lfrenderer {}",
          argument, argument));
  }
  return {};
}

// The parts of the command line of lfsubmit: PACKAGES -- ARGUMENTS, the latter for lfrenderer.
struct Words {
  std::vector<fs::path> files;
  std::vector<std::string> arguments;
};

Result<Words> SplitWords(const std::vector<std::string>& words) {
  Words split;
  const auto arguments = std::find_if(
      words.begin(), words.end(), [](const std::string& word) { return word.starts_with('-'); });
  for (auto word = words.begin(); word != arguments; ++word) {
    if (!IsPackageName(*word))
      return UsageError(
          fmt::format("{}: is not a package (a file that ends in .lfp): make packages with "
                      "lfpreprocessor LIGHTFIELD PATH.yaml -o packages --packages 8",
                      *word));
    split.files.push_back(fs::absolute(*word).lexically_normal());
  }
  split.arguments.assign(arguments, words.end());
  LF_RETURN_IF_ERROR(CheckRendererArguments(split.arguments));
  return split;
}

// Returns true if an option of sbatch only says where and how long tasks run. Other options may
// make Slurm run programs: --export=LD_PRELOAD=..., --wrap, --container, --bbf. A text with a blank
// counts as such an option, because a second option may follow the blank.
bool OnlyAsksForResources(const std::string& option) {
  constexpr auto kHarmless =
      std::to_array<std::string_view>({"--account",       "--partition",   "--qos",
                                       "--time",          "--time-min",    "--begin",
                                       "--deadline",      "--nodelist",    "--exclude",
                                       "--constraint",    "--prefer",      "--reservation",
                                       "--nice",          "--priority",    "--mem",
                                       "--mem-per-cpu",   "--mem-per-gpu", "--cpus-per-task",
                                       "--gres",          "--gpus",        "--gpus-per-node",
                                       "--gpus-per-task", "--licenses",    "--exclusive",
                                       "--hint",          "--tmp",         "--clusters",
                                       "--comment",       "--mail-type",   "--mail-user",
                                       "--requeue",       "--no-requeue",  "--threads-per-core"});
  constexpr std::string_view kShort = "ApqtwxCLM";  // options of one letter; all have a value
  if (option.find_first_of(" \t") != std::string::npos) return false;
  const std::string_view name = std::string_view(option).substr(0, option.find('='));
  if (option.starts_with("--"))
    return std::find(kHarmless.begin(), kHarmless.end(), name) != kHarmless.end();
  return option.size() >= 2 && kShort.find(option[1]) != std::string_view::npos;
}

// Adds --strict to the arguments of lfrenderer, unless they contain it.
void MakeStrict(ClusterJob* job) {
  std::vector<std::string>& words = job->arguments;
  if (std::find(words.begin(), words.end(), "--strict") == words.end())
    words.emplace_back("--strict");
}

// Checks the arguments as lfrenderer would, before a task waits in a queue. Opens the packages as
// *film, and returns the options that the arguments mean.
Result<RenderOptions> TryArguments(const std::vector<fs::path>& packages, const fs::path& output,
                                   const FrameRangeArguments& frames,
                                   const std::vector<std::string>& arguments, PackagedFilm* film) {
  Program renderer("lfrenderer", HelpTexts{});
  RenderArguments render;
  render.AddTo(renderer.app());
  renderer.AddCommonOptions(RenderArguments::Common());
  std::vector<std::string> words = {"lfrenderer"};
  for (const fs::path& package : packages) words.push_back(package.string());
  words.insert(words.end(), {"-o", output.string()});
  if (!frames.range.empty()) words.insert(words.end(), {"--frames", frames.range});
  if (frames.clamp) words.emplace_back("--clamp-frames");
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  try {
    renderer.app().parse(static_cast<int>(argv.size()), argv.data());
  } catch (const CLI::ParseError& error) {
    return UsageError(fmt::format(
        "lfrenderer would refuse the options after --: {}",
        ParseErrorText(renderer.app(), error, static_cast<int>(argv.size()), argv.data())));
  }
  LF_RETURN_IF_ERROR(render.Check(renderer.app().count("--seed") > 0));
  std::optional<LightFieldPlace> place;
  if (!render.light_field.path.empty()) {
    LF_ASSIGN_OR_RETURN(const LightField light_field, render.light_field.Open());
    LF_ASSIGN_OR_RETURN(place, PlaceOf(render.light_field.path, light_field));
  }
  LF_ASSIGN_OR_RETURN(*film, OpenPackages(packages, std::move(place)));
  const Package& first = film->first;
  LF_ASSIGN_OR_RETURN(RenderOptions options,
                      render.MakeOptions(renderer.common(), first.path.frames()));
  LF_RETURN_IF_ERROR(CheckRenderOptions(first, options));
  return options;
}

void AddNewJob(CLI::App& app, SubmitArguments& a) {
  OptionGroup input(app, kInputGroup), output(app, kOutputGroup);
  input
      .Add("PACKAGES", a.words,
           "Packages that lfpreprocessor has written\n"
           "Options after -- are passed to lfrenderer for every package.")
      ->check(NotEmpty());
  output.Add("-o,--output DIR", a.output, "Folder of the frames, shared by all machines")
      ->check(NotEmpty());
  a.frames.AddTo(output, "render", "nothing is submitted");
  AddFilmFiles(output, a.video, a.no_contact_sheet);
  output.AddFlag("--overwrite", a.overwrite,
                 "Remove an earlier job and frames of PACKAGES from DIR\n"
                 "The files of the earlier job, and the frames, reports and unfinished states of "
                 "PACKAGES are removed from DIR. The files PACKAGES are kept, and so are frames of "
                 "other packages in DIR.");
}

void AddExistingJob(CLI::App& app, SubmitArguments& a) {
  OptionGroup running(app, kRunningGroup);
  running.Add("--status DIR", a.status, "Show the progress of the job in DIR")->check(NotEmpty());
  running.Add("--cancel DIR", a.cancel, "End the job in DIR and keep its state")->check(NotEmpty());
  running
      .Add("--resume DIR", a.resume,
           "Continue the job in DIR\n"
           "Packages that are not done are continued. These options may be changed: --engine, "
           "--jobs, --threads, --memory, --crashes, --time-limit, --sbatch, --lfrenderer, --video, "
           "--no-contact-sheet, --strict, and the options of lfrenderer. PACKAGES may be given "
           "again if the files were moved.")
      ->check(NotEmpty());
  running
      .Add("--finish DIR FRAMES", a.finish,
           "Finish frames with the rays that they have so far\n"
           "DIR: the folder of the job; FRAMES: a range, such as 1-10,20. The frames in FRAMES are "
           "written without waiting for their other LF images. All other frames are rendered as "
           "before.")
      ->expected(2);
}

void AddResources(CLI::App& app, SubmitArguments& a) {
  OptionGroup running(app, kRunningGroup);
  running.AddChoice("--engine", a.engine, {"local", "slurm", "openjd", "array"},
                    "System that starts the lfrenderer processes (local)\n"
                    "local: processes on this machine; lfsubmit runs until the film is done\n"
                    "slurm: tasks of Slurm; lfsubmit ends when they are submitted (see --wait)\n"
                    "openjd: writes a job bundle of Open Job Description, which you submit, for "
                    "example to AWS Deadline Cloud\n"
                    "array: writes scripts, which you submit as an array to Grid Engine, PBS, LSF, "
                    "HTCondor, Kubernetes, AWS Batch or another batch system");
  running
      .Add("--write FOLDER", a.write, "Folder of the files for --engine openjd|array (DIR/cluster)")
      ->check(NotEmpty());
  running.Add("--jobs N", a.at_once,
              "Packages rendered at the same time\n"
              "If the option is not given: 1 with --engine local; with --engine slurm, as many as "
              "Slurm starts.");
  running.Add("--memory SIZE", a.memory,
              "Upper limit of the memory of each lfrenderer (8G)\n"
              "With --engine local, the default is less than 8G if the processes of --jobs would "
              "otherwise take more than 80 % of the memory of this machine.");
  running
      .Add("--time-limit TIME", a.time_limit,
           "Time limit of each Slurm task, such as 2h\n"
           "A task that reaches it is requeued and resumed.")
      ->check(NotEmpty());
  running
      .Add("--sbatch OPTION", a.sbatch_options,
           "Option for Slurm's sbatch: --sbatch=--partition=long\n"
           "The option may be given several times.")
      ->allow_extra_args(false);
  running.AddFlag("--wait", a.wait,
                  "Wait until the film is done, for --engine slurm\n"
                  "The exit code is then that of the whole film, as described at the end of this "
                  "help. Without --wait, lfsubmit ends when Slurm has accepted the job.");
  running.Add(
      "--crashes N", a.most_crashes,
      "Most crashes of a package before it fails (10)\n"
      "A package fails if lfrenderer, or the node that runs it, crashes more often than this.");
  running
      .Add("--lfrenderer FILE", a.renderer,
           "Path of lfrenderer (the one beside lfsubmit)\n"
           "The folder of a job does not remember it, because the folder may come from somebody "
           "else: "
           "give it again with --resume. The scripts of --engine slurm, openjd and array name it.")
      ->check(NotEmpty());
}

}  // namespace

void SubmitArguments::AddTo(CLI::App& app) {
  AddNewJob(app, *this);
  AddExistingJob(app, *this);
  AddResources(app, *this);
  OptionGroup of_tasks(app, "");  // options that lfsubmit gives to its own tasks
  of_tasks.Add("--run-package NUMBER DIR", run_package, "")->expected(2);
  of_tasks.Add("--run-finish DIR", run_finish, "");
}

Result<void> SubmitArguments::Check() const {
  const int asked = !status.empty() + !cancel.empty() + !resume.empty() + !finish.empty() +
                    !run_package.empty() + !run_finish.empty();
  if (asked > 1)
    return UsageError(
        "several of --status, --cancel, --resume and --finish are given: give only one of them");
  if (asked == 1 && resume.empty() && !words.empty())
    return UsageError(fmt::format(
        "{}: packages cannot be given with --status, --cancel and --finish, which need only "
        "DIR: leave them out",
        words.front()));
  if (asked == 1 && (!output.empty() || !frames.range.empty() || frames.clamp || overwrite))
    return UsageError(
        "-o, --frames, --clamp-frames and --overwrite can only be used for new jobs, not with "
        "--status, --cancel, --resume and --finish: leave them out");
  if (asked == 1) return {};
  if (words.empty() || words.front().starts_with('-'))
    return UsageError(
        "no packages are given: expected PACKAGES... -o DIR (files of lfpreprocessor), or one of "
        "--status, --cancel, --resume and --finish with DIR");
  if (output.empty()) return UsageError("-o DIR is missing: give the folder of the frames");
  return {};
}

Result<void> SubmitArguments::TakePrograms(ClusterJob* job) const {
  LF_ASSIGN_OR_RETURN(job->renderer, FindRenderer(renderer));
  LF_ASSIGN_OR_RETURN(job->submitter, ProgramFolder());
  job->submitter /= "lfsubmit";
  return {};
}

Result<ClusterJob> SubmitArguments::ReadJobToRun(const std::string& folder) const {
  LF_ASSIGN_OR_RETURN(ClusterJob job, ReadJob(folder));
  LF_RETURN_IF_ERROR(CheckMayRun(job));
  LF_RETURN_IF_ERROR(TakePrograms(&job));
  if (const auto good = CheckRendererArguments(job.arguments); !good)
    return InputError(
        fmt::format("{}: \"arguments\": {}", job.File().string(), good.error().message));
  if (!resume.empty() && sbatch_options.empty() && job.engine == ClusterEngine::kSlurm)
    for (const std::string& option : job.sbatch_options)
      if (!OnlyAsksForResources(option))
        return UsageError(
            fmt::format("{}: \"sbatch_options\" has {}, which may make Slurm run programs that the "
                        "folder names: "
                        "give the options of the job again, as in lfsubmit --resume {} --sbatch={}",
                        job.File().string(), option, ShellWord(folder), ShellWord(option)));
  return job;
}

bool SubmitArguments::HasRendererArguments() const {
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return word.starts_with('-'); });
}

Result<void> SubmitArguments::TakeResources(ClusterJob* job, const CommonOptions& common,
                                            bool is_new) const {
  if (engine) job->engine = *ClusterEngineOf(*engine);
  const bool is_local = job->engine == ClusterEngine::kLocal;
  for (const std::string& option : sbatch_options)
    if (!option.starts_with('-') || OneLine(option) != option)
      return UsageError(fmt::format(
          "--sbatch={}: expected an option of sbatch in one line, such as --partition=long",
          option));
  const bool is_slurm = job->engine == ClusterEngine::kSlurm;
  if (!is_slurm && (!time_limit.empty() || !sbatch_options.empty()))
    return UsageError(
        "--time-limit and --sbatch can only be used with --engine slurm: leave them out, or add "
        "--engine slurm");
  if ((is_local || is_slurm) && !write.empty())
    return UsageError(
        "--write can only be used with --engine openjd and --engine array, which write files for a "
        "farm: leave it out, or add such an engine");
  if (!is_local && !is_slurm && (at_once || wait))
    return UsageError(
        "--jobs and --wait cannot be used with --engine openjd and --engine array, because the "
        "farm starts the tasks: leave them out");
  const bool is_anew = is_new || engine || at_once;
  if (is_anew) {
    job->at_once = at_once.value_or(0);
    if (is_local) job->at_once = std::clamp<size_t>(job->at_once, 1, job->packages.size());
  }
  if (most_crashes) job->most_crashes = *most_crashes;
  if (common.threads > 0)
    job->thread_count = common.threads;
  else if (is_anew)
    job->thread_count = is_local ? std::max(1, MachineThreads() / static_cast<int>(job->at_once))
                                 : static_cast<int>(job->engine != ClusterEngine::kOpenJd);
  if (!memory.empty()) {
    LF_ASSIGN_OR_RETURN(job->memory_bytes, ParseByteSize(memory, "--memory"));
  } else if (is_anew) {
    job->memory_bytes = uint64_t{8} << 30;
    if (is_local)
      job->memory_bytes = std::min(job->memory_bytes, MachineMemoryBytes() / 5 * 4 / job->at_once);
  }
  if (!time_limit.empty()) {
    LF_ASSIGN_OR_RETURN(job->time_limit_s, ParseDuration(time_limit, "--time-limit"));
  }
  if (!sbatch_options.empty()) job->sbatch_options = sbatch_options;
  return {};
}

Result<void> SubmitArguments::Change(ClusterJob* job, const CommonOptions& common) const {
  const ClusterEngine before = job->engine;
  LF_RETURN_IF_ERROR(TakeResources(job, common, false));
  if (before == ClusterEngine::kSlurm && job->engine == ClusterEngine::kLocal) {
    // If Slurm is not installed on this machine, the queue is unknown. The queue is then assumed to
    // have no tasks of the job.
    const auto queue = AskSlurm(*job);
    if (queue && !queue->empty())
      return UsageError(fmt::format(
          "--engine local: {} tasks of the job are still in Slurm's queue: end them first: {}",
          queue->size(), JobCommand("--cancel", job->output_folder)));
  }
  LF_ASSIGN_OR_RETURN(const Words split, SplitWords(words));
  for (const fs::path& file : split.files) {
    const auto package =
        std::find_if(job->packages.begin(), job->packages.end(),
                     [&](const JobPackage& known) { return known.name == file.stem().string(); });
    if (package == job->packages.end())
      return UsageError(fmt::format(
          "{}: is not a package of this job: give files with the names of the job's packages",
          file.string()));
    package->file = file;
  }
  if (!split.arguments.empty()) {
    std::vector<fs::path> files;
    for (const JobPackage& package : job->packages) files.push_back(package.file);
    PackagedFilm film;
    LF_RETURN_IF_ERROR(TryArguments(files, job->output_folder, {}, split.arguments, &film));
    job->arguments = split.arguments;
    std::error_code error;
    job->working_folder = fs::current_path(error);
  }
  if (common.strict) MakeStrict(job);
  if (no_contact_sheet) job->contact_sheet = false;
  if (!video.empty()) {
    job->video = fs::absolute(video).lexically_normal();
    LF_RETURN_IF_ERROR(CheckVideo(*job));
  }
  if (IsForFarm(*job)) LF_RETURN_IF_ERROR(CheckFarmPaths(*job));
  return WriteJob(*job);
}

Result<ClusterJob> SubmitArguments::MakeJob(const CommonOptions& common) const {
  ClusterJob job;
  LF_ASSIGN_OR_RETURN(const Words split, SplitWords(words));
  const std::vector<fs::path>& files = split.files;
  job.arguments = split.arguments;
  if (common.strict) MakeStrict(&job);
  job.output_folder = fs::absolute(output).lexically_normal();
  if (!job.output_folder.has_filename()) job.output_folder = job.output_folder.parent_path();
  std::error_code error;
  job.working_folder = fs::current_path(error);
  LF_RETURN_IF_ERROR(TakePrograms(&job));
  PackagedFilm film;
  LF_ASSIGN_OR_RETURN(const RenderOptions options,
                      TryArguments(files, job.output_folder, frames, job.arguments, &film));
  if (frames.IsNone(options.frames)) return job;
  LF_ASSIGN_OR_RETURN(const std::vector<PackagePart> parts, PartsWith(film, options.frames));
  for (const PackagePart& part : parts)
    job.packages.push_back(
        {part.path, part.path.stem().string(), part.frames, part.is_whole, part.ray_count});
  job.frame_extension = FramePath("", FrameId{1}, options.folder.format).extension().string();
  if (!video.empty()) job.video = fs::absolute(video).lexically_normal();
  LF_RETURN_IF_ERROR(CheckVideo(job));
  job.contact_sheet = !no_contact_sheet;
  LF_RETURN_IF_ERROR(TakeResources(&job, common, true));
  if (IsForFarm(job)) LF_RETURN_IF_ERROR(CheckFarmPaths(job));
  return job;
}

}  // namespace lf
