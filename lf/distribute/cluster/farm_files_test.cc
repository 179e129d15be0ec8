// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/cluster/farm_files.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

ClusterJob FilmOfThree() {
  ClusterJob job;
  job.output_folder = "/films/night's \"work\"";
  job.submitter = "/opt/lf/lfsubmit";
  job.engine = ClusterEngine::kOpenJd;
  job.packages.resize(3);
  job.thread_count = 8;
  job.memory_bytes = uint64_t{4} << 30;
  return job;
}

bool Contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(FarmFiles, ATemplateHasATaskForEachPackage) {
  const std::string text = OpenJdTemplate(FilmOfThree(), {0, 2});
  EXPECT_TRUE(Contains(text, "specificationVersion: jobtemplate-2023-09\n"));
  EXPECT_TRUE(Contains(text, "range: \"0,2\"\n"));
  EXPECT_TRUE(Contains(text, R"(default: "/films/night's \"work\"")"));
  EXPECT_TRUE(Contains(text, R"("{{Task.Param.Package}}", "{{Param.JobFolder}}")"));
  EXPECT_TRUE(Contains(text, "min: 8\n"));
  EXPECT_TRUE(Contains(text, "min: 4352\n"));
  EXPECT_TRUE(Contains(text, "dependsOn: Packages"));
}

TEST(FarmFiles, ATemplateWithoutPackagesOnlyFinishesTheFilm) {
  const std::string text = OpenJdTemplate(FilmOfThree(), {});
  EXPECT_FALSE(Contains(text, "Packages"));
  EXPECT_TRUE(Contains(text, "--run-finish"));
}

TEST(FarmFiles, ScriptsQuoteTheirPaths) {
  for (const std::string& text : {ArrayScript(FilmOfThree()), ArrayFinishingScript(FilmOfThree())})
    EXPECT_TRUE(Contains(text, R"('/films/night'\''s "work"')")) << text;
  EXPECT_TRUE(Contains(ArrayScript(FilmOfThree()), "qsub -t 1-3 "));
  EXPECT_TRUE(Contains(ArrayScript(FilmOfThree()), "--array=0-2 "));
}

TEST(FarmFiles, PathsThatFilesCannotContainAreRefused) {
  for (const char* folder : {"/films/a\nb", "/films/{{Param.JobFolder}}", "/films/\xff"}) {
    ClusterJob job = FilmOfThree();
    job.output_folder = folder;
    const auto written = WriteFarmFiles(job, {0}, "/nonexistent/bundle");
    ASSERT_FALSE(written) << folder;
    EXPECT_EQ(written.error().kind, ErrorKind::kUsage);
  }
}

TEST(FarmFiles, AnotherLfrendererIsNamedByTheTasks) {
  ClusterJob job = FilmOfThree();
  job.renderer = "/opt/lf/lfrenderer";  // the one beside lfsubmit
  for (const std::string& text :
       {OpenJdTemplate(job, {0}), ArrayScript(job), ArrayFinishingScript(job)})
    EXPECT_FALSE(Contains(text, "--lfrenderer")) << text;
  job.renderer = "/new/lfrenderer";
  for (const std::string& text : {ArrayScript(job), ArrayFinishingScript(job)})
    EXPECT_TRUE(Contains(text, " --lfrenderer /new/lfrenderer")) << text;
  const std::string text = OpenJdTemplate(job, {0});
  EXPECT_TRUE(Contains(text, R"(openjd, "--lfrenderer", "/new/lfrenderer"])")) << text;
  EXPECT_TRUE(Contains(text, R"("{{Param.JobFolder}}", "--lfrenderer", "/new/lfrenderer"])"));
  EXPECT_TRUE(Contains(text, R"("$1" --run-finish "${@:2}" --progress openjd &)"));
}

TEST(FarmFiles, NamesOfAnyBytesAreKeptByScripts) {
  ClusterJob job = FilmOfThree();
  job.engine = ClusterEngine::kArray;
  job.output_folder = "/films/\xff";
  EXPECT_TRUE(CheckFarmPaths(job));
  EXPECT_TRUE(Contains(ArrayScript(job), "'/films/\xff'"));
}

}  // namespace
}  // namespace lf
