// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/forecast_report.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

// The forecast of one package with one frame, whose LF cameras are too far apart.
class ForecastReportTest : public ::testing::Test {
 protected:
  ForecastReportTest() {
    RenderCamera camera;
    camera.pinhole.intrinsics = {1000, 1000, 500, 250, 0, 1000, 500};
    camera.focus_distance_w = 2;
    camera.aperture.radius_w = 0.05;
    path_.cameras = {camera};
    FrameForecast frame;
    frame.frame = {1};
    frame.image_count = 30;
    frame.ray_count = 12'000'000;
    frame.density.camera_distance_w = 0.02;
    frame.density.depths = {1.5, 2.5};
    frame.density.near_displacement_px = 1000 * 0.02 * (1 / 1.5 - 1 / 2.);
    frame.density.far_displacement_px = 1000 * 0.02 * (1 / 2. - 1 / 2.5);
    frame.density.coverage = {0, 0.08};
    report_.frames = {frame};
    PackageForecast package;
    package.name = "package-0000";
    package.frames = {{1}};
    package.image_count = 30;
    package.ray_count = 12'000'000;
    package.memory_bytes = size_t{3} << 20;
    report_.packages = {package};
    report_.rate_error = "no image";
    report_.light_field_image_count = 40;
    report_.needed_count = 30;
    facts_.light_field = "field";
  }
  std::string Warnings() const {
    std::string all;
    for (const std::string& warning : DensityWarnings(report_, path_, facts_))
      all += warning + "\n";
    return all;
  }
  void ExpectPart(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }

  CameraPath path_;
  PreprocessReport report_;
  ForecastFacts facts_;
};

TEST_F(ForecastReportTest, ALensBeyondTheCaptureIsCutOffUnlessAHybridCompletesIt) {
  report_.frames[0].density.coverage = {0.3, 0.08};
  ExpectPart(Warnings(), "30 % of its lens are beyond the LF cameras: this part gets no rays");
  facts_.completes = true;
  ExpectPart(Warnings(), "beyond the LF cameras: light of the nearest LF cameras is shown");
  EXPECT_EQ(Warnings().find("cut off"), std::string::npos);
}

TEST_F(ForecastReportTest, TextHasFactsPackagesFramesAndWarnings) {
  facts_.next = "next: lfrenderer\n";
  const std::string text = ForecastText(report_, path_, facts_);
  for (const char* part :
       {"light field    field, 40 LF images\n", "film           1 frames of 1000 x 500\n",
        "time           not known: no image\n", "\npackage-0000   1-1 ", "3 MiB",
        "\nwarning: frame 1: expect double edges, 3 px apart, at 1.5 m", "\nnext: lfrenderer\n"})
    ExpectPart(text, part);
}

TEST_F(ForecastReportTest, UnknownDepthsAreAskedForAsTheCallerCallsThem) {
  ExpectPart(Warnings(), "give depths NEAR FAR, lf_depth_range");
  facts_.depths_argument = "--depths";
  ExpectPart(Warnings(), "give --depths NEAR FAR, lf_depth_range");
  ExpectPart(ForecastJson(report_, path_, facts_), "\"depths_from\": null");
  facts_.depths_from = DepthSource::kStated;
  EXPECT_EQ(Warnings().find("--depths"), std::string::npos);
  ExpectPart(ForecastJson(report_, path_, facts_), "\"depths_from\": \"--depths\"");
  facts_.depths_from = DepthSource::kCalibration;
  ExpectPart(ForecastJson(report_, path_, facts_), "\"depths_from\": \"the calibration\"");
  facts_.depths_from = DepthSource::kLfImages;
  ExpectPart(Warnings(), "(depths estimated from LF images)");
  ExpectPart(ForecastJson(report_, path_, facts_), "\"depths_from\": \"LF images\"");
}

TEST_F(ForecastReportTest, WarnsOfMissingImagesBlackFramesAndCutLenses) {
  report_.missing_count = 2;
  report_.first_missing = "a.png";
  EXPECT_EQ(MissingText(report_),
            "2 of 30 LF images that packages need do not exist, or are empty; the first: a.png");
  report_.frames[0].image_count = 0;
  report_.frames[0].density.least_aperture_w = 0.2;
  report_.frames[0].density.coverage = {0.25, 0.08};
  const std::string warnings = Warnings();
  for (const char* part : {"the first: a.png\n", "1 of 1 frames will be black",
                           "at least 200 mm to collect rays, but has 100 mm",
                           "frame 1: 25 % of its lens are beyond", "an aperture of at most 80 mm"})
    ExpectPart(warnings, part);
  report_ = {};
  EXPECT_EQ(MissingText(report_), "");
}

TEST_F(ForecastReportTest, JsonOfNoFramesHasNoAdvice) {
  ExpectPart(ForecastJson(report_, path_, facts_), "\"resolution\": [");
  report_.frames.clear();
  const std::string json = ForecastJson(report_, path_, facts_);
  ExpectPart(json, "\"advice\": null");
  ExpectPart(json, "\"warnings\": []");
}

}  // namespace
}  // namespace lf
