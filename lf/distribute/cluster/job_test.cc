// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/job.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace lf {
namespace {

ClusterJob SomeJob() {
  ClusterJob job;
  job.output_folder = "/films/a film";
  job.working_folder = "/films";
  job.renderer = "/bin/lfrenderer";
  job.submitter = "/bin/lfsubmit";
  job.packages = {{"/p/package-0000.lfp", "package-0000", {FrameId{1}, FrameId{2}}, true, 10},
                  {"/p/package-0001.lfp", "package-0001", {FrameId{3}, FrameId{5}}, false, 20}};
  job.arguments = {"--format", "png16"};
  job.video = "/films/film.mp4";
  job.engine = ClusterEngine::kSlurm;
  job.at_once = 4;
  job.time_limit_s = 5400;
  job.sbatch_options = {"--partition=long"};
  job.slurm_array_ids = {"12", "15"};
  job.slurm_finishing_id = "16";
  return job;
}

TEST(ClusterJob, IsTheSameWhenWrittenAndRead) {
  const std::string text = ToJson(SomeJob());
  const Result<ClusterJob> job = ParseJob(text, "job");
  ASSERT_TRUE(job.has_value()) << job.error().message;
  EXPECT_EQ(ToJson(*job), text);
  EXPECT_EQ(job->packages[1].frames, SomeJob().packages[1].frames);
  EXPECT_EQ(*job->video, "/films/film.mp4");
}

TEST(ClusterJob, DoesNotNameThePrograms) {
  const std::string text = ToJson(SomeJob());
  EXPECT_EQ(text.find("/bin/"), std::string::npos) << text;
  const std::string with_program =
      text.substr(0, text.find('{') + 1) +
      "\n  \"lfrenderer\": \"/tmp/evil\", \"lfsubmit\": \"/tmp/evil\"," +
      text.substr(text.find('{') + 1);
  const Result<ClusterJob> job = ParseJob(with_program, "job");
  ASSERT_TRUE(job.has_value()) << job.error().message;
  EXPECT_EQ(job->renderer, "");
  EXPECT_EQ(job->submitter, "");
  EXPECT_TRUE(RendererOption(SomeJob()).empty());
  ClusterJob other = SomeJob();
  other.renderer = "/opt/lfrenderer";
  EXPECT_EQ(RendererOption(other), (std::vector<std::string>{"--lfrenderer", "/opt/lfrenderer"}));
  EXPECT_EQ(ResumeCommand(other), "lfsubmit --resume '/films/a film' --lfrenderer /opt/lfrenderer");
  EXPECT_EQ(ResumeCommand(SomeJob()), "lfsubmit --resume '/films/a film'");
}

TEST(ClusterJob, KeepsNamesThatAreNotUtf8) {
  ClusterJob job = SomeJob();
  job.working_folder = "/films/\xff";
  job.packages[0].file = "/p\xfe/package-0000.lfp";
  job.video = "/films/\xff.mp4";
  job.arguments = {"--cache", "/a\xff\xfe"};
  const Result<ClusterJob> read = ParseJob(ToJson(job), "job");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->working_folder, job.working_folder);
  EXPECT_EQ(read->packages[0].file, job.packages[0].file);
  EXPECT_EQ(*read->video, *job.video);
  EXPECT_EQ(read->arguments, job.arguments);
  std::string damaged = ToJson(job);
  const size_t digits = damaged.find("2f66696c6d732fff");  // /films/ and the byte
  ASSERT_NE(digits, std::string::npos) << damaged;
  damaged[digits] = 'x';
  EXPECT_FALSE(ParseJob(damaged, "job").has_value());
}

TEST(ClusterJob, IsRefusedWhereItsNamesWouldLeaveTheFolder) {
  for (const char* name :
       {"../../etc/passwd", "/etc/passwd", "a/../../b", "..", ".hidden", "", "a\nb"}) {
    ClusterJob job = SomeJob();
    job.packages[0].name = name;
    EXPECT_FALSE(ParseJob(ToJson(job), "job").has_value()) << name;
  }
  ClusterJob job = SomeJob();
  job.frame_extension = "/../../a";
  EXPECT_FALSE(ParseJob(ToJson(job), "job").has_value());
}

// A small file must not take much time or memory to read.
TEST(ClusterJob, IsRefusedWhereItNamesTooManyFrames) {
  const auto fault = [](const char* frames, size_t package_count) {
    ClusterJob job = SomeJob();
    job.packages = {job.packages[1]};
    std::string text = ToJson(job);
    text.replace(text.find("3,5"), 3, frames);
    const size_t begin = text.find('{', text.find("\"packages\""));
    const std::string package = text.substr(begin, text.find('}', begin) + 1 - begin);
    for (size_t i = 1; i < package_count; ++i) text.insert(begin, package + ",");
    const Result<ClusterJob> parsed = ParseJob(text, "job");
    return parsed ? "" : parsed.error().message;
  };
  EXPECT_EQ(fault("1-1000000", 10), "");
  EXPECT_NE(fault("1-1000000", 11).find("at most 10000000 frames"), std::string::npos);
  EXPECT_NE(fault("1-99999999", 1).find("more than 10000000 frames"), std::string::npos);
  EXPECT_NE(fault("1-100000000", 1).find("frames from 0 to 99999999"), std::string::npos);
  EXPECT_NE(fault("1-9,9", 1).find("without repeats"), std::string::npos);
  EXPECT_NE(fault("3-1", 1).find("at most the last"), std::string::npos);
}

// These fields become parts of batch scripts and of commands of Slurm.
TEST(ClusterJob, IsRefusedWhereItWouldSlipInCommandsOrOptions) {
  for (const char* option : {"--partition=long\nrm -rf ~", "long", ""}) {
    ClusterJob job = SomeJob();
    job.sbatch_options = {option};
    EXPECT_FALSE(ParseJob(ToJson(job), "job").has_value()) << option;
  }
  for (const char* id : {"--user=root", "12 13", "", "1\n2", "x"}) {
    ClusterJob job = SomeJob();
    job.slurm_array_ids = {"12", id};
    EXPECT_FALSE(ParseJob(ToJson(job), "job").has_value()) << id;
  }
  ClusterJob job = SomeJob();
  job.slurm_finishing_id = "-M all";
  const Result<ClusterJob> parsed = ParseJob(ToJson(job), "job");
  ASSERT_FALSE(parsed.has_value());
  EXPECT_NE(parsed.error().message.find("\"-M all\""), std::string::npos) << parsed.error().message;
}

TEST(ClusterJob, OfAnotherUserIsNotRun) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  ClusterJob job = SomeJob();
  job.output_folder =
      std::filesystem::temp_directory_path() / ("lf_job_test." + std::to_string(::getpid()));
  ASSERT_TRUE(WriteJob(job));
  EXPECT_TRUE(CheckMayRun(job));
  ASSERT_EQ(::chown(job.File().c_str(), 12345, 12345), 0);
  const Result<void> refused = CheckMayRun(job);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_NE(refused.error().message.find("12345"), std::string::npos);
  std::filesystem::remove_all(job.output_folder);
}

TEST(ClusterJob, OtherTextIsNamedAndExplained) {
  for (const char* text : {"", "[]", "{}", R"({"format": "lfjob 9"})"}) {
    const Result<ClusterJob> job = ParseJob(text, "there");
    ASSERT_FALSE(job.has_value()) << text;
    EXPECT_TRUE(job.error().message.starts_with("there: ")) << job.error().message;
  }
}

TEST(FrameRangeText, JoinsNeighbours) {
  EXPECT_EQ(FrameRangeText({}), "");
  EXPECT_EQ(FrameRangeText({FrameId{7}}), "7");
  EXPECT_EQ(
      FrameRangeText({FrameId{1}, FrameId{2}, FrameId{3}, FrameId{7}, FrameId{9}, FrameId{10}}),
      "1-3,7,9-10");
}

}  // namespace
}  // namespace lf
