// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace lf {
namespace {

TEST(Report, CountsEmptyElementsPerChannel) {
  DevelopedFrame developed;
  developed.ray_count = Image<uint32_t>(3, 1, 3);
  const uint32_t counts[] = {0, 5, 9, 0, 6, 1, 4, 7, 0};
  std::copy(std::begin(counts), std::end(counts), developed.ray_count.pixels().begin());
  const FrameReport report = MakeFrameReport(FrameId{4}, {2, 30, 20}, developed);
  EXPECT_EQ(report.empty_element_count, (std::array<uint64_t, 3>{2, 0, 1}));
  EXPECT_EQ(report.min_count, (std::array<uint64_t, 3>{0, 5, 0}));
  EXPECT_EQ(report.median_count, (std::array<uint64_t, 3>{0, 6, 1}));
}

TEST(Report, VirtualLightIsThatOfElementsWithRays) {
  DevelopedFrame developed;
  developed.densified = developed.coverage = Image<float>(5, 1);
  const float densified[] = {0, 0.5F, 0.25F, 0.25F, 1}, coverage[] = {1, 1, 1, 1, 0};
  std::copy(std::begin(densified), std::end(densified), developed.densified.pixels().begin());
  std::copy(std::begin(coverage), std::end(coverage), developed.coverage.pixels().begin());
  developed.doubtful_count = 3;
  RenderReport report;
  report.frames = {MakeFrameReport(FrameId{1}, {}, developed),
                   {FrameId{2}, {}, {}, {}, {}, 0, {}, {}}};
  EXPECT_EQ(report.frames[0].virtual_light, (VirtualLight{0.25, 0.75}));
  EXPECT_FALSE(report.frames[1].virtual_light);
  developed.doubtful_count = 1;
  report.frames.push_back(MakeFrameReport(FrameId{3}, {}, developed));
  EXPECT_EQ(report.MeanVirtualLight(), (VirtualLight{0.25, 0.5}));
  developed.coverage = Image<float>(5, 1);
  EXPECT_EQ(MakeFrameReport(FrameId{4}, {}, developed).virtual_light, VirtualLight());
  EXPECT_FALSE(RenderReport().MeanVirtualLight());
  const auto json = nlohmann::json::parse(ToJson(report));
  EXPECT_EQ(json["doubtful_share"], 0.5);
  EXPECT_EQ(json["frames"][2]["densified_share"], 0.25);
  EXPECT_FALSE(json["frames"][1].contains("densified_share"));
}

TEST(Report, IsJsonEvenWithNamesThatAreNoText) {
  RenderReport report;
  report.frames.push_back({FrameId{7}, {3, 100, 90}, {}, {}, {}, 0, {}, {}});
  report.skipped.push_back({"a\xff.png", "broken", 0});
  const nlohmann::json json = nlohmann::json::parse(ToJson(report));
  EXPECT_EQ(json["frames"][0]["frame"], 7);
  EXPECT_EQ(json["rays_tested"], 100);
  EXPECT_EQ(json["skipped_lf_images"][0]["reason"], "broken");
}

TEST(Report, CountsEveryLfImageThatWasLeftOutOnce) {
  RenderReport report;
  const std::vector<SkippedImage> images = {{"a.png", "broken", 0}, {"b.png", "is gone", 3}};
  report.AddSkipped(images);
  report.AddSkipped(std::vector<SkippedImage>{{"b.png", "later", 3}, {"c.png", "broken", 1}});
  report.packages = {{"package-0000", 25, 2}, {"package-0001", 20, 0}};
  const auto json = nlohmann::json::parse(ToJson(report));
  EXPECT_EQ(json["lf_images_skipped"], 3);
  EXPECT_EQ(json["skipped_lf_images"][1]["reason"], "is gone");
  EXPECT_EQ(json["packages"].size(), 2u);
  EXPECT_EQ(json["packages"][0]["lf_images_skipped"], 2);
  EXPECT_EQ(json["packages"][1]["lf_images_selected"], 20);
}

TEST(Report, TheWorstOfTheRebinnedRaysCounts) {
  RenderReport report;
  report.AddRebinning({2, 50, 100, 1.5, "edges"});
  report.AddRebinning({1, 70, 10, 0.5, "all"});
  EXPECT_FALSE(report.rebinning->pixels);
  EXPECT_EQ(report.rebinning->slab_count, 2u);
  EXPECT_EQ(report.rebinning->cell_count, 70u);
  EXPECT_EQ(report.rebinning->looked_at_count, 110u);
  EXPECT_EQ(report.rebinning->cpu_s, 2);
  EXPECT_EQ(report.rebinning->kept, "edges");
  report.AddRebinning({0, 0, 0, 0, "some"});
  report.AddRebinning({0, 0, 0, 0, "edges"});
  EXPECT_EQ(report.rebinning->kept, "some");
}

// A guarded frame of virtual LF images alone is no black frame, although it has no recorded rays.
TEST(Report, LightOfVirtualImagesIsNotBlack) {
  RenderReport report;
  report.frames.resize(2);
  EXPECT_TRUE(report.IsBlack());
  report.frames[1].rays.virtual_count = 3;
  EXPECT_FALSE(report.IsBlack());
}

// A report names kept pixels, and not cells, and reads them back.
TEST(Report, TheLeastShareOfKeptPixelsCounts) {
  RenderReport report;
  report.AddRebinning({.looked_at_count = 100, .pixels = RebinReport::Pixels{90, 0.9}});
  report.AddRebinning(
      {.looked_at_count = 200, .kept = "some", .pixels = RebinReport::Pixels{80, 0.4}});
  report.AddRebinning({.looked_at_count = 10, .pixels = RebinReport::Pixels{10, 1}});
  const auto json = nlohmann::json::parse(ToJson(report));
  EXPECT_EQ(json["rebinning"]["pixels"], 90);
  EXPECT_EQ(json["rebinning"]["cells"], 0);
  EXPECT_EQ(json["rebinning"]["kept_share"], 0.4);
  const RenderReport again = ParseReport(ToJson(report), "report").value();
  ASSERT_TRUE(again.rebinning && again.rebinning->pixels);
  EXPECT_EQ(again.rebinning->pixels->count, 90u);
  EXPECT_EQ(again.rebinning->pixels->kept_share, 0.4);
  EXPECT_EQ(again.rebinning->looked_at_count, 310u);
}

TEST(Report, ReadsBackWhatItWrote) {
  RenderReport report;
  report.inputs = {{"seed", "5"}, {"estimator", "nearest"}};
  report.selected_image_count = 17;
  report.total_s = 1.25;
  report.collect_cpu_s = 0.1;
  report.peak_memory_bytes = 123456789;
  report.skipped = {{"a.png", "is broken", 0}};
  FrameReport frame;
  frame.frame = FrameId{7};
  frame.rays = {3, uint64_t{1} << 60, 90};
  frame.empty_element_count = {1, 2, 3};
  frame.median_count = {7, 8, 9};
  frame.samples = FrameSamples{8, {0.25, 3}};
  frame.weighed = {12.5, 0.25, {0.75}};
  frame.noise = FrameNoise{0.002, 0.0019, 72, 70};
  frame.virtual_light = VirtualLight{0.375, 0.125};
  frame.camera = {{"frame", "7"}};
  report.frames = {frame, {FrameId{9}, {}, {}, {}, {}, 0, {}, {}}};
  EXPECT_EQ(ToJson(report).find("virtual"), std::string::npos);
  report.selected_virtual_count = 30;
  report.frames[0].rays.virtual_count = 20;
  const auto json = nlohmann::json::parse(ToJson(report));
  EXPECT_EQ(json["virtual_lf_images_selected"], 30);
  EXPECT_EQ(json["frames"][0]["virtual_lf_images"], 20);
  EXPECT_EQ(json["frames"][0]["lf_images"], 3);
  const Result<RenderReport> read = ParseReport(ToJson(report), "x");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->selected_virtual_count, 30u);
  EXPECT_EQ(read->frames[0].rays.virtual_count, 20u);
  EXPECT_EQ(read->frames[1].rays.virtual_count, 0u);
  EXPECT_EQ(read->inputs, report.inputs);
  EXPECT_EQ(read->selected_image_count, 17u);
  EXPECT_EQ(read->total_s, 1.25);
  EXPECT_EQ(read->collect_cpu_s, 0.1);
  EXPECT_EQ(read->peak_memory_bytes, 123456789u);
  EXPECT_EQ(read->skipped[0].reason, "is broken");
  ASSERT_EQ(read->frames.size(), 2u);
  EXPECT_EQ(read->frames[0].rays.tested_count, uint64_t{1} << 60);
  EXPECT_EQ(read->frames[0].median_count, frame.median_count);
  EXPECT_EQ(read->frames[0].samples->measured.share, 0.25);
  EXPECT_EQ(read->frames[0].samples->measured.most_have, 3u);
  EXPECT_EQ(read->frames[0].noise->asked, 0.002);
  EXPECT_EQ(read->frames[0].noise->reached, 0.0019);
  EXPECT_EQ(read->frames[0].noise->ranks, 72u);
  EXPECT_EQ(read->frames[0].noise->image_count, 70u);
  EXPECT_FALSE(read->frames[1].noise);
  EXPECT_EQ(read->frames[0].camera, frame.camera);
  EXPECT_FALSE(read->frames[1].samples);
  ASSERT_TRUE(read->frames[0].weighed);
  EXPECT_EQ(read->frames[0].weighed->effective_count, 12.5);
  EXPECT_EQ(read->frames[0].weighed->hat_share, 0.25);
  EXPECT_EQ(read->frames[0].weighed->coverage.uncovered_share, 0.75);
  EXPECT_FALSE(read->frames[1].weighed);
}

TEST(Report, OtherTextsAreErrorsThatNameTheFieldAndTheFile) {
  for (const auto& [text, word] :
       {std::pair("", "no JSON"),
        {"{}", "format"},
        {R"({"format":"lfreport 1"})", "\"lfreport 1\", which builds of lfrendertools from before"},
        {R"({"format":"lfreport 3"})", "expected \"lfreport 2\", found \"lfreport 3\";"},
        {"[]", "expected an object"},
        {R"({"format":"lfreport 2","seconds":"x"})", "\"seconds\": expected a number"},
        {R"({"format":"lfreport 2","frames":[{}]})", "number from 0"},
        {R"({"format":"lfreport 2","frames":[{"frame":1,"lf_images":-1}]})", "lf_images"},
        {R"({"format":"lfreport 2","frames":[{"frame":1,"inputs":{"a":1}}]})", "inputs"}}) {
    const Result<RenderReport> report = ParseReport(text, "some.json");
    ASSERT_FALSE(report) << text;
    EXPECT_EQ(report.error().message.find("some.json: "), 0u);
    EXPECT_NE(report.error().message.find(word), std::string::npos) << report.error().message;
  }
}

}  // namespace
}  // namespace lf
