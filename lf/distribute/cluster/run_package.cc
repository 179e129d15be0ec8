// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/run_package.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "lf/core/child_process.h"
#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/log.h"
#include "lf/core/shell_word.h"
#include "lf/core/temporary_file.h"
#include "lf/distribute/cluster/finish_frames.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr auto kTick = std::chrono::milliseconds(50);
// Ticks from one look at the files of other processes to the next: one second, because these files
// may be on a file server.
constexpr int kTicksPerLook = 20;

double SecondsSince1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

// Returns the kind of error that an exit code of lfrenderer stands for; 1 is a bug in it. 0 and
// other codes are failures of a program that we call.
ErrorKind KindOfExit(int exit_code) {
  const bool is_ours = exit_code >= 1 && exit_code <= static_cast<int>(ErrorKind::kBelowRequired);
  return is_ours ? static_cast<ErrorKind>(exit_code) : ErrorKind::kOutput;
}

// A task that this process runs: holds its lock, and writes its log and state.
class TaskRun {
 public:
  TaskRun(const ClusterJob& job, ClusterTask task, std::string node, const std::atomic<bool>& stop)
      : job_(job), task_(std::move(task)), node_(std::move(node)), stop_(stop) {}

  // Takes the task's lock, then reads its state.
  Result<void> Begin();
  TaskState& state() { return state_; }
  bool IsAskedToEnd() const { return stop_ || job_.IsCancelled(); }
  Result<void> End(TaskPhase phase, int exit_code, const std::string& message);

  // Runs lfrenderer once. If `output` is not empty, standard output is written to this file.
  // `wants_restart` is called about once a second; once it or IsAskedToEnd() returns true,
  // lfrenderer gets SIGTERM.
  Result<ProcessEnd> Run(const std::vector<std::string>& words, const fs::path& output,
                         const std::function<bool()>& wants_restart);
  // Returns the error that lfrenderer has ended with, with the last message in the log. A program
  // that ends with another code, or with 1 and without a message, is no lfrenderer: kOutput.
  Error ErrorOf(int exit_code) const;

 private:
  const ClusterJob& job_;
  const ClusterTask task_;
  const std::string node_;
  const std::atomic<bool>& stop_;
  std::optional<FileLock> lock_;
  TaskState state_;
};

// Waits for the lock for up to two minutes. The process that held the lock may have just died,
// while the lfrenderer that it started still holds the lock and writes a checkpoint.
Result<void> TaskRun::Begin() {
  constexpr double kPatience_s = 120;
  const double begin_s = SecondsSince1970();
  while (!lock_) {
    Result<FileLock> lock = FileLock::Take(task_.lock);
    if (lock) {
      lock_ = *std::move(lock);
    } else if (!FileLock::IsHeld(task_.lock)) {
      // Either the lock was released in the meantime, or the lock file cannot be created.
      lock = FileLock::Take(task_.lock);
      if (!lock && !FileLock::IsHeld(task_.lock)) return lock.error();
      if (lock) lock_ = *std::move(lock);
    } else if (stop_ || SecondsSince1970() - begin_s > kPatience_s) {
      return lock.error();
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  }
  LF_ASSIGN_OR_RETURN(state_, ReadTaskState(task_.state));
  return {};
}

Error TaskRun::ErrorOf(int exit_code) const {
  constexpr std::string_view kError = "error: ";
  std::string message = ReadProgress(task_.log).message;
  if (message.starts_with(kError)) message.erase(0, kError.size());
  if (!message.empty()) return {KindOfExit(exit_code), message};
  return {exit_code == 1 ? ErrorKind::kOutput : KindOfExit(exit_code),
          fmt::format("{} ended with exit code {} and without a message; its log: {}",
                      job_.renderer.string(), exit_code, task_.log.string())};
}

Result<void> TaskRun::End(TaskPhase phase, int exit_code, const std::string& message) {
  state_.phase = phase;
  state_.exit_code = exit_code;
  state_.message = message;
  state_.end_s = SecondsSince1970();
  return WriteTaskState(state_, task_.state);
}

Result<ProcessEnd> TaskRun::Run(const std::vector<std::string>& words, const fs::path& output,
                                const std::function<bool()>& wants_restart) {
  const auto open = [](const fs::path& path, int flags) {
    return ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0666);
  };
  const int log = open(task_.log, O_APPEND);
  if (log < 0)
    return OutputError(
        fmt::format("{}: cannot be written: {}", task_.log.string(), std::strerror(errno)));
  const std::string header =
      fmt::format("{}{:%F %T} UTC on {}: start {}\n", kLogStart,
                  fmt::gmtime(std::chrono::system_clock::now()), node_, state_.start_count + 1);
  [[maybe_unused]] const ssize_t told = ::write(log, header.data(), header.size());
  ChildProcess::Options options;
  options.words = words;
  options.working_folder = job_.working_folder;
  options.complaints = log;
  options.output = output.empty() ? -1 : open(output, O_TRUNC);
  options.kept = lock_->fd();
  const Result<std::unique_ptr<ChildProcess>> command = ChildProcess::Start(options);
  ::close(log);
  if (options.output >= 0) ::close(options.output);
  if (!command) return command.error();
  if (const auto shared = lock_->ShareWith((*command)->process()); !shared)
    LogWarning("{}", shared.error().message);
  ++state_.start_count;
  LogDebug("{}: start {}, process {}: {}", task_.name, state_.start_count, (*command)->process(),
           ShellCommand(words));
  state_.phase = TaskPhase::kRunning;
  state_.node = node_;
  state_.process = (*command)->process();
  state_.begin_s = SecondsSince1970();
  state_.message.clear();
  // An error is only logged, because the running lfrenderer matters more than its state file.
  if (const auto written = WriteTaskState(state_, task_.state); !written)
    LogWarning("{}", written.error().message);
  bool is_told = false;
  for (int tick = 1;; ++tick) {
    if (const auto end = (*command)->Poll()) {
      LogDebug("{}: ended, {}", task_.name,
               end->signal != 0 ? fmt::format("by signal {}", end->signal)
                                : fmt::format("with exit code {}", end->exit_code));
      return *end;
    }
    const bool looks = tick % kTicksPerLook == 0;
    if (!is_told && (stop_ || (looks && (job_.IsCancelled() || wants_restart())))) {
      (*command)->Signal(SIGTERM);
      is_told = true;
    }
    std::this_thread::sleep_for(kTick);
  }
}

std::vector<std::string> RendererWords(const ClusterJob& job, const std::vector<fs::path>& files) {
  std::vector<std::string> words = {job.renderer.string()};
  for (const fs::path& file : files) words.push_back(file.string());
  words.insert(words.end(), {"-o", job.output_folder.string(), "--resume", "--progress", "json",
                             "--threads", fmt::format("{}", job.thread_count)});
  if (job.memory_bytes > 0)
    words.insert(words.end(), {"--memory", fmt::format("{}", job.memory_bytes)});
  words.insert(words.end(), job.arguments.begin(), job.arguments.end());
  return words;
}

std::vector<std::string> PackageWords(const ClusterJob& job, const JobPackage& package,
                                      const std::vector<FrameId>& finish) {
  std::vector<std::string> words = RendererWords(job, {package.file});
  words.emplace_back("--no-contact-sheet");
  if (!package.is_whole) words.insert(words.end(), {"--frames", FrameRangeText(package.frames)});
  if (!finish.empty()) words.insert(words.end(), {"--finish", FrameRangeText(finish)});
  return words;
}

std::string WordsOf(const ProcessEnd& end) {
  return fmt::format(
      "killed by signal {} ({}){}", end.signal, ::strsignal(end.signal),
      end.signal == SIGKILL ? ": by a user, or by the system because it used too much memory" : "");
}

std::vector<FrameId> MissingFrames(const ClusterJob& job, const JobPackage& package) {
  std::vector<FrameId> missing;
  std::error_code ignored;
  for (const FrameId frame : package.frames) {
    const std::string name = fmt::format("frame_{:04}{}", frame.value, job.frame_extension);
    if (!fs::exists(job.output_folder / name, ignored)) missing.push_back(frame);
  }
  return missing;
}

// Returns an error that names all packages that are not done. The kind of the error is the kind
// with which the first failed package ended; kInterrupted if no package failed.
Result<void> CheckAllDone(const ClusterJob& job) {
  std::string words;
  ErrorKind kind = ErrorKind::kInterrupted;
  for (size_t i = 0; i < job.packages.size(); ++i) {
    const ClusterTask task = PackageTask(job, i);
    const JobPackage& package = job.packages[i];
    LF_ASSIGN_OR_RETURN(const TaskState state, ReadTaskState(task.state));
    const std::vector<FrameId> missing = MissingFrames(job, package);
    if (state.phase == TaskPhase::kDone && missing.empty()) continue;
    std::string reason = NameOf(state.phase);
    if (state.phase == TaskPhase::kFailed && kind == ErrorKind::kInterrupted)
      kind = KindOfExit(state.exit_code);
    if (!state.message.empty()) reason += fmt::format(" on {}: {}", state.node, state.message);
    if (state.phase == TaskPhase::kDone) reason = "done, but their files are missing";
    words += fmt::format("{}{} (frames {}: {})", words.empty() ? "" : "; ", task.name,
                         FrameRangeText(missing.empty() ? package.frames : missing), reason);
  }
  if (words.empty()) return {};
  return Error{kind, fmt::format("{}: not all packages are done: {}; to continue: {}",
                                 job.output_folder.string(), words, ResumeCommand(job))};
}

}  // namespace

Result<void> OutcomeOf(const std::string& name, const TaskState& state) {
  constexpr int kBelow = static_cast<int>(ErrorKind::kBelowRequired);
  if (state.phase == TaskPhase::kDone && state.exit_code == kBelow)
    return Error{ErrorKind::kBelowRequired, fmt::format("{}: {}", name, state.message)};
  if (state.phase == TaskPhase::kDone) return {};
  const ErrorKind kind =
      state.phase == TaskPhase::kFailed ? KindOfExit(state.exit_code) : ErrorKind::kInterrupted;
  return Error{kind, fmt::format("{}: {}: {}", name, NameOf(state.phase), state.message)};
}

Result<TaskState> RunPackage(const ClusterJob& job, size_t number, const std::string& node,
                             const std::atomic<bool>& stop, const std::function<void()>& look) {
  const JobPackage& package = job.packages[number];
  TaskRun run(job, PackageTask(job, number), node, stop);
  LF_RETURN_IF_ERROR(run.Begin());
  TaskState& state = run.state();
  if (state.phase == TaskPhase::kDone) {
    if (MissingFrames(job, package).empty()) return state;
    state.phase = TaskPhase::kInterrupted;  // the user removed frames to have them rendered again
  }
  // The process that wrote kRunning has died, because this process now holds the lock.
  if (state.phase == TaskPhase::kRunning) {
    ++state.crash_count;
    LF_RETURN_IF_ERROR(run.End(TaskPhase::kInterrupted, 0, "its process or node died"));
  }
  while (true) {
    if (run.IsAskedToEnd()) {
      LF_RETURN_IF_ERROR(run.End(TaskPhase::kInterrupted, 5, state.message));
      return state;
    }
    if (state.crash_count > job.most_crashes) {
      LF_RETURN_IF_ERROR(run.End(
          TaskPhase::kFailed, 4,
          fmt::format("crashed {} times, the last time: {}", state.crash_count, state.message)));
      return state;
    }
    LF_ASSIGN_OR_RETURN(const std::vector<FrameId> finish, FramesToFinish(job, package));
    const auto wants_restart = [&] {
      if (look) look();
      const auto now = FramesToFinish(job, package);
      return now && *now != finish;
    };
    const Result<ProcessEnd> ran = run.Run(PackageWords(job, package, finish), {}, wants_restart);
    if (!ran) {
      LF_RETURN_IF_ERROR(run.End(TaskPhase::kFailed, 4, ran.error().message));
      return state;
    }
    const ProcessEnd end = *ran;
    if (end.signal == SIGTERM) {
      LF_RETURN_IF_ERROR(run.End(TaskPhase::kInterrupted, 5, "interrupted before it started"));
    } else if (end.signal != 0) {
      ++state.crash_count;
      LF_RETURN_IF_ERROR(run.End(TaskPhase::kInterrupted, 0, WordsOf(end)));
    } else if (end.exit_code == 0 || end.exit_code == 6) {
      LF_RETURN_IF_ERROR(run.End(TaskPhase::kDone, end.exit_code,
                                 end.exit_code == 0 ? "" : run.ErrorOf(6).message));
      return state;
    } else if (end.exit_code == 5) {
      LF_RETURN_IF_ERROR(
          run.End(TaskPhase::kInterrupted, 5, "interrupted; it continues when it runs again"));
    } else {
      const Error error = run.ErrorOf(end.exit_code);
      LF_RETURN_IF_ERROR(run.End(TaskPhase::kFailed, static_cast<int>(error.kind), error.message));
      return state;
    }
  }
}

Result<void> FinishFilm(const ClusterJob& job, const std::string& node,
                        const std::atomic<bool>& stop) {
  TaskRun run(job, FinishingTask(job), node, stop);
  LF_RETURN_IF_ERROR(run.Begin());
  const auto fail = [&](const Error& error) -> Error {
    const TaskPhase phase =
        error.kind == ErrorKind::kInterrupted ? TaskPhase::kInterrupted : TaskPhase::kFailed;
    if (const auto ended = run.End(phase, static_cast<int>(error.kind), error.message); !ended)
      LogWarning("{}", ended.error().message);
    return error;
  };
  if (const Result<void> done = CheckAllDone(job); !done) return fail(done.error());
  if (run.IsAskedToEnd()) return fail({ErrorKind::kInterrupted, "interrupted"});
  std::vector<fs::path> files;
  std::vector<FrameId> frames;
  bool is_whole = true;
  for (const JobPackage& package : job.packages) {
    files.push_back(package.file);
    frames.insert(frames.end(), package.frames.begin(), package.frames.end());
    is_whole = is_whole && package.is_whole;
  }
  std::sort(frames.begin(), frames.end());
  std::vector<std::string> words = RendererWords(job, files);
  words.emplace_back("--json");
  if (!is_whole) words.insert(words.end(), {"--frames", FrameRangeText(frames)});
  if (job.video) words.insert(words.end(), {"--video", job.video->string()});
  if (!job.contact_sheet) words.emplace_back("--no-contact-sheet");
  // Removes the report of an earlier finishing task, because it would look like the result of this
  // task if this task failed.
  const fs::path report = job.Folder() / "report.json";
  std::error_code ignored;
  fs::remove(report, ignored);
  TemporaryFile printed(report);
  const Result<ProcessEnd> end = run.Run(words, printed.path(), [] { return false; });
  if (!end) return fail(end.error());
  // The SIGTERM of Run() arrived before lfrenderer could catch it.
  if (end->signal == SIGTERM && run.IsAskedToEnd())
    return fail({ErrorKind::kInterrupted, "interrupted"});
  if (end->signal != 0) return fail(OutputError("the finishing task was " + WordsOf(*end)));
  if (end->exit_code != 0 && end->exit_code != 6) return fail(run.ErrorOf(end->exit_code));
  const std::string last = end->exit_code == 0 ? "" : run.ErrorOf(6).message;
  if (const Result<void> kept = RenameFlushed(printed.path(), report); !kept)
    return fail(kept.error());
  printed.Keep();
  LF_RETURN_IF_ERROR(run.End(TaskPhase::kDone, end->exit_code, last));
  if (end->exit_code == 0) return {};
  return Error{
      ErrorKind::kBelowRequired,
      fmt::format(
          "{}; {{overwrite}} renders the film anew; to check it again with other options of "
          "lfrenderer, such as {{allow_missing}}: {} -- OPTIONS",
          last, ResumeCommand(job))};
}

}  // namespace lf
