// The command line of lfsubmit, and the job it describes.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/common/program.h"

#include "lf/cluster/job.h"
#include "lf/core/result.h"

namespace lf {

struct SubmitArguments {
  std::vector<std::string> words;  // PACKAGES, and after "--" the arguments of lfrenderer
  std::string output, frames, video, memory, time_limit, renderer, engine = "local";
  uint64_t at_once = 0;
  uint32_t most_crashes = 10;
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

  // Reads all packages, and tries the arguments of lfrenderer.
  Result<ClusterJob> MakeJob(const CommonOptions& common) const;
};

}  // namespace lf
