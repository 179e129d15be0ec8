// A job: the packages of a film and how many processes, here or on many machines, render them
// (doc/cluster.md). No service runs beside them; the job and its progress are files beside the
// frames.
//
//   DIR/cluster/job.json                 the job
//   DIR/cluster/packages/NAME.json .log  progress of a package (task_state.h); output of lfrenderer
//   DIR/cluster/packages/NAME.lock       held while it is rendered
//   DIR/cluster/finish.json .log .lock   likewise for the finishing task: video, contact sheet
//   DIR/cluster/finish_frames.json       frames to be finished early
//   DIR/cluster/lock                     held while a job is submitted, resumed or run locally
//   DIR/cluster/cancelled                exists if the job is to end
//   DIR/cluster/*.sbatch, slurm-*.out    of the engine slurm
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

enum class ClusterEngine { kLocal, kSlurm };
const char* NameOf(ClusterEngine engine);
std::optional<ClusterEngine> ClusterEngineOf(std::string_view name);  // nullopt: another word

struct JobPackage {
  std::filesystem::path file;
  std::string name;             // of the file, without extension
  std::vector<FrameId> frames;  // to be rendered, ascending
  bool is_whole = true;         // `frames` are all frames of the package
  uint64_t ray_count = 0;       // of these frames, approximately
};

struct ClusterJob {
  std::filesystem::path output_folder;   // DIR
  std::filesystem::path working_folder;  // of the programs; relative paths begin here
  std::filesystem::path renderer;        // lfrenderer
  std::filesystem::path submitter;       // lfsubmit, for scripts
  std::vector<JobPackage> packages;
  std::vector<std::string> arguments;  // of lfrenderer, for all packages
  std::string frame_extension = ".exr";
  std::optional<std::filesystem::path> video;
  bool contact_sheet = true;

  ClusterEngine engine = ClusterEngine::kLocal;
  size_t at_once = 0;          // packages rendered at the same time; 0: no limit (slurm)
  int thread_count = 1;        // of each task
  uint64_t memory_bytes = 0;   // of each task
  uint32_t most_crashes = 10;  // of a package, which fails if it crashes more often
  double time_limit_s = 0;     // slurm; 0: the limit of the partition
  std::vector<std::string> sbatch_options;

  // The ids that sbatch returned, the last submission last.
  std::vector<std::string> slurm_array_ids;
  std::string slurm_finishing_id;

  std::filesystem::path Folder() const { return output_folder / "cluster"; }
  std::filesystem::path File() const { return Folder() / "job.json"; }
  std::filesystem::path CancelFile() const { return Folder() / "cancelled"; }
  std::filesystem::path FinishFramesFile() const { return Folder() / "finish_frames.json"; }
  // Held by the local engine while it runs, and by programs that change the job (TakeJob()).
  std::filesystem::path EngineLock() const { return Folder() / "lock"; }
  bool IsCancelled() const;
};

// A task of the job: a package, or the finishing task.
struct ClusterTask {
  std::string name;  // in the names of its files, and in messages
  std::filesystem::path state, log, lock;
};
ClusterTask PackageTask(const ClusterJob& job, size_t number);
ClusterTask FinishingTask(const ClusterJob& job);

// Returns "1-3,7" in the syntax of ParseFrameRange(), ascending.
std::string FrameRangeText(const std::vector<FrameId>& frames);

std::string ToJson(const ClusterJob& job);
// kInput if the text is no job; messages call it `name`.
Result<ClusterJob> ParseJob(std::string_view text, const std::string& name);

Result<void> WriteJob(const ClusterJob& job);
// Reads the job of the folder DIR. kInput: there is none, or it is damaged.
Result<ClusterJob> ReadJob(const std::filesystem::path& output_folder);

// kUsage if job.json belongs to another user, because a job's commands run with the rights of the
// caller.
Result<void> CheckMayRun(const ClusterJob& job);

}  // namespace lf
