// SPDX-License-Identifier: Apache-2.0
// A job: the packages of a film, and how processes on this or many machines render them
// (doc/cluster.md). There is no server: the job and its progress are files in the output folder.
//
//   DIR/cluster/job.json                 the job
//   DIR/cluster/packages/NAME.json .log  state of a package (task_state.h), and output of
//                                        lfrenderer
//   DIR/cluster/packages/NAME.lock       locked while the package is rendered
//   DIR/cluster/finish.json .log .lock   the same for the finishing task, which makes the video and
//                                        the contact sheet
//   DIR/cluster/report.json              report of the finishing task
//   DIR/cluster/finish_frames.json .lock frames to finish early, and the lock of this list
//   DIR/cluster/lock                     locked while the job is submitted, resumed or run locally
//   DIR/cluster/cancelled                exists if the job is cancelled
//   DIR/cluster/*.sbatch, slurm-*.out    batch scripts and their output (engine slurm)
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

enum class ClusterEngine {
  kLocal,
  kSlurm,
  kOpenJd,  // the user submits a job bundle of Open Job Description (farm_files.h)
  kArray,   // the user submits a script as an array to any batch system (farm_files.h)
};
const char* NameOf(ClusterEngine engine);
std::optional<ClusterEngine> ClusterEngineOf(std::string_view name);  // nullopt: no engine's name

struct JobPackage {
  std::filesystem::path file;
  std::string name;             // name of the file without extension
  std::vector<FrameId> frames;  // frames to render, ascending
  bool is_whole = true;         // true if `frames` are all frames of the package
  uint64_t ray_count = 0;       // approximate number of rays of `frames`
};

struct ClusterJob {
  std::filesystem::path output_folder;   // folder DIR of the frames and of the job's own files
  std::filesystem::path working_folder;  // folder where lfrenderer runs; relative paths start here
  // The two programs that run are those of the call. The folder of a job does not name them,
  // because it may come from somebody else, in an archive: ReadJob() leaves them empty.
  std::filesystem::path renderer;   // path of lfrenderer
  std::filesystem::path submitter;  // path of lfsubmit, for batch scripts
  std::vector<JobPackage> packages;
  std::vector<std::string> arguments;  // arguments of lfrenderer for all packages
  std::string frame_extension = ".exr";
  std::optional<std::filesystem::path> video;
  bool contact_sheet = true;

  ClusterEngine engine = ClusterEngine::kLocal;
  // number of packages rendered at the same time; 0: no limit (slurm), one (local)
  size_t at_once = 0;
  int thread_count = 1;        // number of threads of each task; 0: all of the machine
  uint64_t memory_bytes = 0;   // --memory of lfrenderer in each task; 0: lfrenderer's default
  uint32_t most_crashes = 10;  // a package that crashes more often fails
  double time_limit_s = 0;     // time limit of a task (slurm); 0: the partition's limit
  std::vector<std::string> sbatch_options;

  // The job ids that sbatch returned for arrays of packages, oldest first.
  std::vector<std::string> slurm_array_ids;
  std::string slurm_finishing_id;  // job id of the finishing task; empty: not submitted

  std::filesystem::path Folder() const { return output_folder / "cluster"; }
  std::filesystem::path File() const { return Folder() / "job.json"; }
  std::filesystem::path CancelFile() const { return Folder() / "cancelled"; }
  std::filesystem::path FinishFramesFile() const { return Folder() / "finish_frames.json"; }
  // Returns the file that the local engine locks while it runs, and that programs lock while they
  // change the job (TakeJob()).
  std::filesystem::path EngineLock() const { return Folder() / "lock"; }
  bool IsCancelled() const;
};

// The name and the files of a task of the job: a package, or the finishing task.
struct ClusterTask {
  std::string name;  // name of the package, or "finish"; used in messages
  std::filesystem::path state, log, lock;
};
// Returns the task that renders job.packages[number].
ClusterTask PackageTask(const ClusterJob& job, size_t number);
ClusterTask FinishingTask(const ClusterJob& job);

// Returns the words by which a task of the job tells lfsubmit which lfrenderer to run: --lfrenderer
// and its path, or none if it is the one beside lfsubmit.
std::vector<std::string> RendererOption(const ClusterJob& job);
// Returns these words for a shell, each after a blank.
std::string RendererOptionText(const ClusterJob& job);
// Returns the command that continues the job, for messages.
std::string ResumeCommand(const ClusterJob& job);

// Returns a text such as "1-3,7", which ParseFrameRange() reads.
//   frames  ascending
std::string FrameRangeText(const std::vector<FrameId>& frames);

std::string ToJson(const ClusterJob& job);
// Parses the text of ToJson(). kInput if it is no valid job; the message begins with `name`.
Result<ClusterJob> ParseJob(std::string_view text, const std::string& name);

Result<void> WriteJob(const ClusterJob& job);
// Reads the job in the folder DIR, which may have been moved since WriteJob(). kInput: there is no
// job, or it is damaged.
Result<ClusterJob> ReadJob(const std::filesystem::path& output_folder);
// Returns a command of lfsubmit for a job, such as `lfsubmit --status film`, for messages.
std::string JobCommand(const std::string& option, const std::filesystem::path& output_folder);

// Returns kUsage if job.json belongs to another user (except root), because lfrenderer would run
// with the options in it and the rights of the caller. kInput: job.json cannot be read.
Result<void> CheckMayRun(const ClusterJob& job);

}  // namespace lf
