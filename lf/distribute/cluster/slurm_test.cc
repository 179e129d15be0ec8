// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/slurm.h"

#include <gtest/gtest.h>

#include "lf/core/child_process.h"

namespace lf {
namespace {

ClusterJob SlurmJob() {
  ClusterJob job;
  job.output_folder = "/films/a film";
  job.submitter = "/bin/lfsubmit";
  job.packages.resize(3);
  job.thread_count = 8;
  job.memory_bytes = uint64_t{4} << 30;
  job.time_limit_s = 5400;
  job.sbatch_options = {"--partition=long"};
  job.slurm_array_ids = {"12", "15"};
  job.slurm_finishing_id = "16";
  return job;
}

TEST(SlurmScripts, SayWhatTheJobAsksFor) {
  const std::string script = PackagesScript(SlurmJob());
  for (const char* line :
       {"--cpus-per-task=8\n", "#SBATCH --mem=4352M\n", "#SBATCH --time=1:30:00\n",
        "#SBATCH --partition=long\n", "#SBATCH --requeue\n", "#SBATCH --signal=B:TERM@120\n",
        "--run-package \"$SLURM_ARRAY_TASK_ID\" '/films/a film' &", "sbatch --array=0-2 "})
    EXPECT_NE(script.find(line), std::string::npos) << line << "\n" << script;
  EXPECT_NE(FinishingScript(SlurmJob()).find("--run-finish '/films/a film'\n"), std::string::npos);
}

TEST(SlurmScripts, AreBash) {
  for (const std::string& script : {PackagesScript(SlurmJob()), FinishingScript(SlurmJob())}) {
    const Result<CommandAnswer> answer = RunCommand({"bash", "-n", "-c", script}, 10);
    ASSERT_TRUE(answer.has_value()) << answer.error().message;
    EXPECT_EQ(answer->exit_code, 0) << answer->complaints;
  }
}

TEST(SlurmScripts, EndWhereTheNumberOfThePackageIsEmpty) {
  ClusterJob job = SlurmJob();
  job.submitter = "/bin/echo";
  for (const char* const variable : {"SLURM_ARRAY_TASK_ID=", "OTHER=1"}) {
    const auto answer = RunCommand(
        {"env", "-u", "SLURM_ARRAY_TASK_ID", variable, "bash", "-c", PackagesScript(job)}, 10);
    ASSERT_TRUE(answer.has_value()) << answer.error().message;
    EXPECT_EQ(answer->exit_code, 2);
    EXPECT_NE(answer->complaints.find("SLURM_ARRAY_TASK_ID"), std::string::npos);
    EXPECT_EQ(answer->output, "");
  }
}

TEST(SlurmArray, JoinsNeighbours) {
  EXPECT_EQ(ArrayText({0, 1, 2, 5, 7, 8}), "0-2,5,7-8");
  EXPECT_EQ(ArrayText({4}), "4");
}

TEST(SlurmQueue, TellsTheTasksOfTheJob) {
  const std::vector<QueuedTask> tasks = ParseQueue(
      "12|0|RUNNING|n3|None\n15|2|PENDING||Resources\n16|N/A|PENDING||Dependency\n"
      "99|1|RUNNING|n1|None\n12|77|RUNNING|n1|None\nrubbish\n\n",
      SlurmJob());
  ASSERT_EQ(tasks.size(), 3u);
  EXPECT_EQ(tasks[0].number, 0u);
  EXPECT_EQ(tasks[0].node, "n3");
  EXPECT_EQ(tasks[1].number, 2u);
  EXPECT_EQ(tasks[1].state, "PENDING");
  EXPECT_EQ(tasks[1].reason, "Resources");
  EXPECT_TRUE(tasks[2].is_finishing);
}

}  // namespace
}  // namespace lf
