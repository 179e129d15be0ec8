// A job: the packages of a film and how they are rendered, by many processes here or on many
// machines (doc/cluster.md). Nothing runs beside them: what a job is, and how far, are files that
// lie beside the frames.
//
//   DIR/cluster/job.json                 the job
//   DIR/cluster/packages/NAME.json .log  how far a package is (task_state.h); what lfrenderer said
//   DIR/cluster/packages/NAME.lock       held while it is rendered
//   DIR/cluster/finish.json .log .lock   the same of the finishing task: video, contact sheet
//   DIR/cluster/finish_frames.json       frames to be finished early
//   DIR/cluster/lock                     held while a job is submitted, resumed or run locally
//   DIR/cluster/cancelled                is there when the job is to end
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

struct JobPackage {
  std::filesystem::path file;
  std::string name;             // of the file, without extension
  std::vector<FrameId> frames;  // to be rendered, ascending
  bool is_whole = true;         // all of its frames
  uint64_t ray_count = 0;       // of these frames, about
};

struct ClusterJob {
  std::filesystem::path output_folder;   // DIR
  std::filesystem::path working_folder;  // of the programs: where relative paths begin
  std::filesystem::path renderer;        // lfrenderer
  std::filesystem::path submitter;       // lfsubmit, for scripts
  std::vector<JobPackage> packages;
  std::vector<std::string> arguments;  // of lfrenderer, for all packages
  std::string frame_extension = ".exr";
  std::optional<std::filesystem::path> video;
  bool contact_sheet = true;

  ClusterEngine engine = ClusterEngine::kLocal;
  size_t at_once = 0;          // packages rendered at the same time; 0: no limit (slurm)
  int thread_count = 1;        // of each
  uint64_t memory_bytes = 0;   // of each
  uint32_t most_crashes = 10;  // of a package: more than these, and it has failed
  double time_limit_s = 0;     // slurm; 0: that of the partition
  std::vector<std::string> sbatch_options;

  // What sbatch answered, the last submission last.
  std::vector<std::string> slurm_array_ids;
  std::string slurm_finishing_id;

  std::filesystem::path Folder() const { return output_folder / "cluster"; }
  std::filesystem::path File() const { return Folder() / "job.json"; }
  std::filesystem::path CancelFile() const { return Folder() / "cancelled"; }
  std::filesystem::path FinishFramesFile() const { return Folder() / "finish_frames.json"; }
  // Held by the local engine while it runs, and by whoever changes the job (TakeJob()).
  std::filesystem::path EngineLock() const { return Folder() / "lock"; }
  bool IsCancelled() const;
};

// One of the job's tasks: a package, or the finishing one.
struct ClusterTask {
  std::string name;  // of its files, and for people
  std::filesystem::path state, log, lock;
};
ClusterTask PackageTask(const ClusterJob& job, size_t number);
ClusterTask FinishingTask(const ClusterJob& job);

// "1-3,7": as ParseFrameRange() reads it. Ascending.
std::string FrameRangeText(const std::vector<FrameId>& frames);

std::string ToJson(const ClusterJob& job);
// kInput: no such text; the message calls it `name`.
Result<ClusterJob> ParseJob(std::string_view text, const std::string& name);

Result<void> WriteJob(const ClusterJob& job);
// Of the folder DIR. kInput: there is none, or it is damaged.
Result<ClusterJob> ReadJob(const std::filesystem::path& output_folder);

// kUsage if its file belongs to another user: what a job names is run as the one who asks.
Result<void> CheckMayRun(const ClusterJob& job);

}  // namespace lf
