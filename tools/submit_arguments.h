// The command line of lfsubmit, and the job it describes.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/program.h"

#include "lf/cluster/job.h"
#include "lf/core/result.h"

namespace lf {

struct SubmitArguments {
  std::vector<std::string> words;  // PACKAGES, and after "--" the arguments of lfrenderer
  std::string output, frames, video, memory, time_limit, renderer;
  std::optional<std::string> engine;  // local
  std::optional<uint64_t> at_once;
  std::optional<uint32_t> most_crashes;
  std::vector<std::string> sbatch_options;
  bool no_contact_sheet = false, overwrite = false, wait = false;
  // Of a job that is there.
  std::string status, cancel, resume;
  std::vector<std::string> finish;       // DIR FRAMES
  std::vector<std::string> run_package;  // NUMBER DIR
  std::string run_finish;

  void AddTo(CLI::App& app);
  // One thing at a time.
  Result<void> Check() const;
  // True if there are arguments of lfrenderer.
  bool HasRendererArguments() const;

  // Reads all packages, and tries the arguments of lfrenderer.
  Result<ClusterJob> MakeJob(const CommonOptions& common) const;
  // What is given of engine, processes, memory and limits, for a job that is gone on with.
  Result<void> Change(ClusterJob* job, const CommonOptions& common) const;

 private:
  Result<void> TakeResources(ClusterJob* job, const CommonOptions& common, bool is_new) const;
};

}  // namespace lf
