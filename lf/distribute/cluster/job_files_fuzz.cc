// SPDX-License-Identifier: Apache-2.0
// The parsers of a job's files and of a batch system's output must accept or refuse any text.
// Accepted jobs and states must not change when they are written and read again.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "lf/core/check.h"
#include "lf/distribute/cluster/job.h"
#include "lf/distribute/cluster/slurm.h"
#include "lf/distribute/cluster/task_state.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  if (const auto job = lf::ParseJob(text, "j")) {
    const std::string written = lf::ToJson(*job);
    const auto again = lf::ParseJob(written, "j");
    LF_CHECK(again && lf::ToJson(*again) == written);
    lf::PackagesScript(*job);
  } else {
    LF_CHECK(job.error().message.starts_with("j: "));
  }
  if (const auto state = lf::ParseTaskState(text, "s")) {
    const std::string written = lf::ToJson(*state);
    const auto again = lf::ParseTaskState(written, "s");
    LF_CHECK(again && lf::ToJson(*again) == written);
  } else {
    LF_CHECK(state.error().message.starts_with("s: "));
  }
  const lf::TaskProgress progress = lf::ParseProgress(text);
  LF_CHECK(progress.done <= progress.total);
  lf::ClusterJob job;
  job.packages.resize(4);
  job.slurm_array_ids.emplace_back("1");
  job.slurm_finishing_id.push_back('2');
  for (const lf::QueuedTask& task : lf::ParseQueue(text, job)) LF_CHECK(task.number < 4);
  return 0;
}
