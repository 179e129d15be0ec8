// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/compress_report.h"

#include <gtest/gtest.h>

#include <limits>

namespace lf {
namespace {

class CompressReportTest : public ::testing::Test {
 protected:
  CompressReportTest() {
    options_.store = "a.lfs";
    report_.image_count = 25;
    report_.coded_count = 24;
    report_.pixel_bytes = 8'000'000;
    report_.code_bytes = 1'000'000;
    report_.source_bytes = 2'000'000;
    report_.store_bytes = 1'500'000;
    report_.total_s = 2;
    report_.worst_psnr_db = std::numeric_limits<double>::infinity();
    report_.skipped = {{"b.png", "is cut off"}};
  }
  CompressOptions options_;
  CompressReport report_;
};

TEST_F(CompressReportTest, TextStatesRatioQualityAndWhatIsSkipped) {
  const std::string text = CompressText(report_, options_, "next: lfrenderer\n");
  for (const char* part :
       {"a.lfs: 24 LF images of 25, 1.5 MB in all; ", "pixels    8 MB, encoded 1 MB: 8.00 : 1\n",
        "files     2 MB: 2.00 : 1\n", "quality   exact\n", "speed     4 MB/s of pixels",
        "skipped   b.png: is cut off\nnext: lfrenderer\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  EXPECT_EQ(text.find("note:"), std::string::npos);
  report_.source_bytes = 10;
  EXPECT_NE(CompressText(report_, options_, "").find("use the files instead of the store"),
            std::string::npos);
}

TEST_F(CompressReportTest, DemosaickingIsTested) {
  GuardErrors errors;
  errors.single = 4;
  errors.joint = 0.2;
  errors.kept = 0.4;
  errors.count = 4000;
  errors.block_count = 50;
  errors.joint_block_count = 49;
  report_.demosaicked = errors;
  report_.source_bytes = 10;
  const std::string text = CompressText(report_, options_, "");
  EXPECT_NE(text.find("demosaic  40.0 dB at tested pixels, 30.0 dB without neighbours; 98 % of"),
            std::string::npos)
      << text;
  // The image files hold mosaics, which are no substitute for the store.
  EXPECT_EQ(text.find("use the files"), std::string::npos);
  EXPECT_NE(CompressJson(report_, options_).find("\"joint_share\": 0.98"), std::string::npos);
}

TEST_F(CompressReportTest, JsonKeepsNamesThatAreNoUtf8) {
  report_.skipped[0].name = "b\xff.png";
  report_.verified_count = 24;
  const std::string json = CompressJson(report_, options_);
  for (const char* part : {"\"store\": \"a.lfs\"", "\"ratio\": 8.0", "\"psnr_db\": \"exact\"",
                           "\"verified\": 24", "\"name\": \"b\xef\xbf\xbd.png\""})
    EXPECT_NE(json.find(part), std::string::npos) << part << "\nis not in\n" << json;
}

TEST_F(CompressReportTest, TheFirstMissingImageIsNamed) {
  EXPECT_EQ(MissingText(report_, options_),
            "a.lfs: 1 of 25 LF images are not in the store, because they are missing or broken; "
            "the first: b.png: is cut off");
  report_.skipped.clear();
  EXPECT_EQ(MissingText(report_, options_), "");
}

TEST_F(CompressReportTest, ProgressHasTheRatioOnceItIsKnown) {
  EXPECT_EQ(ProgressDetail({}), "coding");
  EXPECT_EQ(ProgressDetail({.pixel_bytes = 124, .code_bytes = 10}), "12.4 : 1");
  EXPECT_EQ(ProgressDetail({.code_bytes = 10, .phase = CompressPhase::kVerifying}), "verifying");
  EXPECT_EQ(ProgressDetail({.phase = CompressPhase::kChoosing}), "choosing");
}

}  // namespace
}  // namespace lf
