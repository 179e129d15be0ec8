// SPDX-License-Identifier: Apache-2.0
// Files for render farms that lfsubmit does not control: the user submits them, and each task calls
// lfsubmit --run-package or --run-finish. A package that was interrupted resumes from its
// checkpoint whenever its task runs again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// Returns true if the user submits the tasks of the job to a farm.
inline bool IsForFarm(const ClusterJob& job) {
  return job.engine == ClusterEngine::kOpenJd || job.engine == ClusterEngine::kArray;
}

// Returns a job template of Open Job Description (jobtemplate-2023-09): a step whose tasks render
// packages (`numbers`: indices in job.packages, ascending), and a step that makes contact sheet and
// video. Tasks get SIGTERM two minutes before they are killed. The first step is left out if there
// are no packages.
std::string OpenJdTemplate(const ClusterJob& job, const std::vector<size_t>& numbers);

// Returns a batch script that renders one package. The number of the package is the number of the
// task in an array of Slurm, PBS, Grid Engine, LSF, Kubernetes, AWS Batch or HTCondor, less 1 for
// Grid Engine and LSF, whose tasks begin at 1; or the first argument of the script.
std::string ArrayScript(const ClusterJob& job);
// Returns a batch script for the finishing task.
std::string ArrayFinishingScript(const ClusterJob& job);

// Returns kUsage if WriteFarmFiles() would, because a path of the job contains characters that
// files for farms cannot contain: control characters, "{{" and bytes that are not UTF-8 in
// templates.
Result<void> CheckFarmPaths(const ClusterJob& job);

// Writes template.yaml (kOpenJd), or packages.sh and finish.sh (kArray) into a folder, which it
// creates, and returns the path of the first. kUsage: CheckFarmPaths(). kOutput: the folder cannot
// be written.
Result<std::filesystem::path> WriteFarmFiles(const ClusterJob& job,
                                             const std::vector<size_t>& numbers,
                                             const std::filesystem::path& folder);

}  // namespace lf
