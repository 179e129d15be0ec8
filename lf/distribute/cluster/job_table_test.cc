// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/job_table.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

class JobTableTest : public ::testing::Test {
 protected:
  JobTableTest() {
    job_.output_folder = "frames";
    job_.at_once = 2;
    TaskStatus done, running;
    done.name = "package-0000";
    done.state.phase = TaskPhase::kDone;
    done.state.start_count = 1;
    done.frames_done = done.frame_total = 4;
    done.rays_done = done.ray_total = 100;
    running.name = "package-0001";
    running.state.phase = TaskPhase::kRunning;
    running.state.start_count = 3;
    running.frame_total = 4;
    running.rays_done = 50;
    running.ray_total = 100;
    running.rate = 2e6;
    running.unit = "rays";
    running.message = std::string(100, 'm');
    status_.phase = TaskPhase::kRunning;
    status_.packages = {done, running};
    status_.finishing.name = "finish";
  }
  ClusterJob job_;
  JobStatus status_;
};

TEST_F(JobTableTest, TheSummaryCountsPackagesFramesAndRays) {
  EXPECT_EQ(JobSummary(status_), "1 of 2 packages done, 1 running; 4 of 8 frames, 75 %");
  EXPECT_EQ(JobSummary({}), "0 of 0 packages done; 0 of 0 frames, 0 %");
}

TEST_F(JobTableTest, EachTaskHasARow) {
  const std::string table = JobTable(job_, status_);
  for (const char* part : {"frames: running on this machine, 2 at a time: 1 of 2 packages done",
                           "\npackage-0000  done", "\npackage-0001  running", "2 Mrays/s", "50 %",
                           "\nfinish", "mmm...\n"})
    EXPECT_NE(table.find(part), std::string::npos) << part << "\nis not in\n" << table;
  EXPECT_EQ(table.find("LF images"), std::string::npos) << "an empty column\n" << table;
}

TEST_F(JobTableTest, AJobThatNeedsResumeSaysHowToContinue) {
  const std::string advice = "\nto continue: lfsubmit --resume frames\n";
  EXPECT_EQ(JobTable(job_, status_).find("to continue"), std::string::npos);
  for (const TaskPhase phase : {TaskPhase::kInterrupted, TaskPhase::kFailed, TaskPhase::kWaiting}) {
    status_.phase = phase;
    EXPECT_TRUE(JobTable(job_, status_).ends_with(advice)) << JobTable(job_, status_);
  }
  job_.engine = ClusterEngine::kSlurm;
  EXPECT_EQ(JobTable(job_, status_).find("to continue"), std::string::npos) << "waits for Slurm";
  status_.phase = TaskPhase::kDone;
  EXPECT_EQ(JobTable(job_, status_).find("to continue"), std::string::npos);
}

TEST_F(JobTableTest, SlurmIsTranslated) {
  job_.engine = ClusterEngine::kSlurm;
  job_.slurm_array_ids = {"7", "9"};
  status_.packages[1].queue = "PENDING";
  status_.packages[1].message = "BeginTime";
  status_.queue_error = "squeue is missing";
  const std::string table = JobTable(job_, status_);
  for (const char* part : {"on slurm (array 7, 9, finishing -)", "queued again",
                           "waits two minutes", "the queue cannot be queried (squeue is missing)"})
    EXPECT_NE(table.find(part), std::string::npos) << part << "\nis not in\n" << table;
}

}  // namespace
}  // namespace lf
