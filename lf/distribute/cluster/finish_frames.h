// Frames of a job that are good enough for the user: they are finished with the rays they have,
// while the other frames continue (lfrenderer --finish).
#pragma once

#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/distribute/cluster/job.h"

namespace lf {

// Adds frames ("10-20", "7") to those to be finished early. Returns how many of them are not
// finished. kUsage: other text; a frame that is not in the job, or that has no rays yet because it
// was not started or has no checkpoint.
Result<size_t> AskToFinish(const ClusterJob& job, const std::string& frames_text);

// Returns the frames of a package that are to be finished early, ascending. kInput: the file is
// damaged.
Result<std::vector<FrameId>> FramesToFinish(const ClusterJob& job, const JobPackage& package);

}  // namespace lf
