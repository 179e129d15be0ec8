// SPDX-License-Identifier: Apache-2.0
// The command line of lfsubmit, and the job it describes.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/frame_options.h"
#include "tools/common/program.h"

#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// Options of lfrenderer that are refused after --. The first kRenderNothingCount make it print a
// text and render nothing; on the others, the job decides.
inline constexpr size_t kRenderNothingCount = 5;
inline constexpr std::array kRefusedAfterDashes = {
    "--help",        "-h",         "--help-all", "--version",
    "--describe",    "-o",         "--output",   "--resume",
    "--overwrite",   "--progress", "--json",     "--frames",
    "--video",       "--shard",    "--finish",   "--threads",
    "--memory",      "-q",         "--quiet",    "--no-contact-sheet",
    "--clamp-frames"};

struct SubmitArguments {
  std::vector<std::string> words;  // PACKAGES, and after "--" the arguments of lfrenderer
  std::string output, video, memory, time_limit, renderer, write;
  FrameRangeArguments frames;
  std::optional<std::string> engine;  // unset: local for a new job, unchanged for a resumed one
  std::optional<uint64_t> at_once;
  std::optional<uint32_t> most_crashes;
  std::vector<std::string> sbatch_options;
  bool no_contact_sheet = false, overwrite = false, wait = false;
  // The arguments below are for an existing job.
  std::string status, cancel, resume;
  std::vector<std::string> finish;       // the two values of --finish: DIR FRAMES
  std::vector<std::string> run_package;  // the two values of --run-package: NUMBER DIR
  std::string run_finish;

  void AddTo(CLI::App& app);
  // kUsage unless exactly one action is requested (a new job, or one on an existing job) with the
  // arguments that it needs, and no others.
  Result<void> Check() const;
  // Returns true if arguments of lfrenderer are given.
  bool HasRendererArguments() const;

  // Returns a new job. Reads all packages and checks the arguments of lfrenderer. The job has no
  // packages if --clamp-frames leaves out all frames.
  Result<ClusterJob> MakeJob(const CommonOptions& common) const;
  // Reads the job in a folder whose tasks will be run by the programs of this call. kUsage: the
  // folder belongs to another user; or --resume without --sbatch would give Slurm options of the
  // folder that may run programs. kInput: there is no job, or it has options of lfrenderer that may
  // not follow --.
  Result<ClusterJob> ReadJobToRun(const std::string& folder) const;
  // Applies the given arguments to a job that is resumed, and writes the job to its file.
  Result<void> Change(ClusterJob* job, const CommonOptions& common) const;

 private:
  // Sets the programs of the job: this lfsubmit, and the lfrenderer beside it or of --lfrenderer.
  Result<void> TakePrograms(ClusterJob* job) const;
  Result<void> TakeResources(ClusterJob* job, const CommonOptions& common, bool is_new) const;
};

}  // namespace lf
