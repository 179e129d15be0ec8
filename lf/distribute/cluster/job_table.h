// SPDX-License-Identifier: Apache-2.0
// Shows the progress of a job to people.
#pragma once

#include <string>

#include "lf/distribute/cluster/job.h"
#include "lf/distribute/cluster/job_status.h"

namespace lf {

// Returns one line about the whole job, and a table with a row for each package and for the
// finishing task.
std::string JobTable(const ClusterJob& job, const JobStatus& status);

// Returns a summary such as "3 of 8 packages done, 2 running; 214 of 480 frames, 47 %". The
// percentage is that of the rays.
std::string JobSummary(const JobStatus& status);

}  // namespace lf
