// SPDX-License-Identifier: Apache-2.0
// The list of the frames of a job that the user wants to finish early, because they are good
// enough: they are finished with the rays that they have, while the other frames continue
// (lfrenderer --finish).
#pragma once

#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// Adds frames ("10-20", "7") to the list, unless the files of all of them exist. Returns how many
// of these frames have no file yet. kUsage: the text has another form; a frame is not in the job,
// or has no rays yet because it was not started or has no checkpoint. kInput: the file of the list
// is damaged. kOutput: the list cannot be locked or written.
Result<size_t> AskToFinish(const ClusterJob& job, const std::string& frames_text);

// Returns the frames of a package that are on the list, ascending. kInput: the file of the list is
// damaged.
Result<std::vector<FrameId>> FramesToFinish(const ClusterJob& job, const JobPackage& package);

}  // namespace lf
