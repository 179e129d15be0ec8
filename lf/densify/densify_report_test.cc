// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_report.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

class DensifyReportTest : public ::testing::Test {
 protected:
  DensifyReportTest() {
    options_.store = "d.lfs";
    options_.choices.spacing_px = 1;
    report_.recorded_count = 24;
    report_.virtual_count = 100;
    report_.range = {0, 0.5};
    report_.planes = 30;
    report_.spacing_px = 1;
    report_.skipped = {{"b.png", "is cut off"}};
    report_.left_out = {"c.png", "d.png"};
    report_.kept_share = 0.8;
    report_.tests = {{"a.png", 40, 36.5, 2}};
    options_.cache = "a.depths";
    report_.cached_planes = 7;
  }
  DensifyOptions options_;
  DensifyReport report_;
};

TEST_F(DensifyReportTest, TextStatesDepthsAndTests) {
  const std::string text = DensifyText(report_, options_, 65, "next: lfrenderer\n");
  for (const char* part :
       {"d.lfs: 24 recorded and 100 virtual LF images\n", "depths    2 to infinity; 30 were",
        "skipped   b.png: is cut off\n", "left out  2 LF images", "have 80 % of the",
        "nearness to the lenses: c.png, d.png\n", "3.5 dB better than a mean",
        "40.0 dB (mean: 36.5 dB)", "cache     a.depths: had 7 depth planes of an earlier call\n",
        "; 1 min 5 s\nnext: lfrenderer\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  EXPECT_EQ(text.find("note:"), std::string::npos);
  report_.spacing_px = 2;
  EXPECT_NE(DensifyText(report_, options_, 1, "").find("note: 1 px need more virtual LF images"),
            std::string::npos);
  report_.was_there = true;
  EXPECT_NE(DensifyText(report_, options_, 1, "").find("existed already"), std::string::npos);
}

TEST_F(DensifyReportTest, JsonHasAllTestsAndSkippedImages) {
  const std::string json = DensifyJson(report_, options_, 65);
  for (const char* part : {"\"recorded\": 24", "\"virtual\": 100", "\"lf_image\": \"a.png\"",
                           "\"reason\": \"is cut off\"", "\"kept_share\": 0.8", "\"total_s\": 65.0",
                           "\"cache\": \"a.depths\"", "\"cached_planes\": 7"})
    EXPECT_NE(json.find(part), std::string::npos) << part << "\nis not in\n" << json;
  options_.cache.clear();
  EXPECT_NE(DensifyJson(report_, options_, 65).find("\"cache\": null"), std::string::npos);
}

TEST_F(DensifyReportTest, TheFirstMissingImageIsNamed) {
  EXPECT_EQ(MissingText(report_, options_),
            "d.lfs: 1 of 27 LF images were not used, because they are missing or broken; the "
            "first: b.png: is cut off");
  report_.skipped.clear();
  EXPECT_EQ(MissingText(report_, options_), "");
}

}  // namespace
}  // namespace lf
