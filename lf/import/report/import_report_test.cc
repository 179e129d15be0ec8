// SPDX-License-Identifier: Apache-2.0
#include "lf/import/report/import_report.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

class ImportReportTest : public ::testing::Test {
 protected:
  ImportReportTest() {
    report_.light_field = "capture";
    report_.first_image = "capture/a.jpg";
    report_.capture.image_count = 25;
    report_.capture.unit_m = 0.01;
    report_.capture.box_min_w = {-1, 0, 1e-17};
    report_.capture.box_max_w = {1, 2.5, 0};
  }
  void ExpectPart(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }
  ImportReport report_;
};

TEST_F(ImportReportTest, TextHasALineForEachFact) {
  ExpectPart(ReportText(report_), "images         25, not checked\n");
  report_.faults.emplace();
  report_.faults->missing = {{LfImageId{3}, "b.jpg: not found"}};
  report_.excluded_count = 2;
  report_.pixels = FootprintFacts{PixelFootprint::kPoint, true};
  report_.capture.spacing_w = Spread{0.5, 0.5, 0.50000001};
  report_.capture.warnings = {{"upside-down", "turn it", 6, {"a.jpg", "b.jpg"}}};
  report_.written = "native/transforms.json";
  report_.next = "next: lfexample\n";
  const std::string text = ReportText(report_);
  for (const char* part :
       {"light field    capture\nfirst image    capture/a.jpg\n",
        "images         25, 2 left out, 1 missing, 0 broken\n",
        "pixels         show the light of points, as renders without anti-aliasing do (stated by ",
        "positions      from -1, 0, 0 to 1, 2.5, 0\n",
        "spacing        0.5 to the nearest neighbour\n",
        "optical axes   do not come near one another before the cameras\n",
        "unit           1 world unit counts as 0.01 m", "density        unknown: give the distance",
        "\nwarning: upside-down: turn it\n  a.jpg, b.jpg, ...\n",
        "\nwritten: native/transforms.json\n\nnext: lfexample\n"})
    ExpectPart(text, part);
}

TEST_F(ImportReportTest, ExposureHasLinesAndKeys) {
  report_.capture.brackets = FoundBrackets{.pose_count = 25,
                                           .image_count = 75,
                                           .least_exposures = 3,
                                           .most_exposures = 3,
                                           .stops = {-2, 0.001, 1.996},
                                           .are_gains = true,
                                           .of_images = {}};
  report_.exif_gains = ExifGains{75, 0.25F, 4, true, {}};
  MatchedExposure matched;
  matched.gains.resize(10);
  matched.left_alone = {LfImageId{0}};
  matched.unreadable = {LfImageId{1}};
  matched.sample_count = 1000;
  matched.step_before = 0.1;
  matched.step_after = 0.0123;
  matched.falloff = FoundFalloff{0.6, 0.6, 0.8, 1};
  report_.exposure = matched;
  const std::string text = ReportText(report_), json = ReportJson(report_);
  for (const char* part :
       {"brackets       25 poses x 3 exposures, -2, 0 and +2 stops by lf_gain\n",
        "gains          0.25 to 4 for 75 images, ", "exposure       8 of 10 images matched by 1000",
        "seams          10.00 % between neighbouring images before, 1.23 % after\n",
        "falloff        60.0 % of the light is left in the corners"})
    ExpectPart(text, part);
  for (const char* part : {"\"poses\": 25", "\"has_f_numbers\": true", "\"matched\": 8",
                           "\"corner_min\": 0.6", "\"from\": \"lf_gain\""})
    ExpectPart(json, part);
}

TEST_F(ImportReportTest, JsonHasNullForWhatIsUnknown) {
  report_.light_field = "caf\xe9";
  const std::string json = ReportJson(report_);
  for (const char* part : {"\"light_field\": \"caf\xef\xbf\xbd\"", "\"missing\": null",
                           "\"density\": null", "\"written\": null", "\"exposure\": null"})
    ExpectPart(json, part);
}

TEST_F(ImportReportTest, FaultsBecomeWarnings) {
  LightField field;
  field.image_names = {"a.jpg", "b.jpg", "c.jpg"};
  field.cameras.resize(3);
  report_.faults.emplace();
  report_.faults->broken = {{LfImageId{2}, "c.jpg: is cut off"}, {LfImageId{1}, "b.jpg: empty"}};
  WarnOfFaults(field, &report_);
  ASSERT_EQ(report_.capture.warnings.size(), 1u);
  const CaptureWarning& warning = report_.capture.warnings[0];
  EXPECT_EQ(warning.kind, "broken-images");
  EXPECT_EQ(warning.message,
            "2 of 3 images are broken and will be skipped. The first: c.jpg: is cut off");
  EXPECT_EQ(warning.names, (std::vector<std::string>{"c.jpg", "b.jpg"}));
}

}  // namespace
}  // namespace lf
