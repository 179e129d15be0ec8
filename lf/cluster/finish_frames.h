// Frames of a job that somebody finds good enough: they are finished with the rays they have, and
// the others go on (lfrenderer --finish).
#pragma once

#include <string>
#include <vector>

#include "lf/cluster/job.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

// Adds frames ("10-20", "7") to those that are to be finished early, and tells how many of them are
// not finished. kUsage: no such text; a frame that is not in the job, or that has no rays yet: it
// was not begun, or has no checkpoint.
Result<size_t> AskToFinish(const ClusterJob& job, const std::string& frames_text);

// Those of a package that were asked for, ascending. kInput: the file is damaged.
Result<std::vector<FrameId>> FramesToFinish(const ClusterJob& job, const JobPackage& package);

}  // namespace lf
