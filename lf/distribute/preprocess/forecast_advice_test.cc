// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/forecast_advice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(ForecastAdvice, LengthsHaveUnitsThatPeopleReadOff) {
  EXPECT_EQ(LengthText(0, 1), "0");
  EXPECT_EQ(LengthText(2e-5, 1), "20 um");
  EXPECT_EQ(LengthText(3.12, 0.01), "31.2 mm");
  EXPECT_EQ(LengthText(2.05, 1), "2.05 m");
  EXPECT_EQ(LengthText(-1200, 1), "-1.2 km");
  EXPECT_EQ(LengthText(kInfinity, 1), "-");
}

TEST(ForecastAdvice, RangesAreRoundedInwards) {
  EXPECT_EQ(RangeText({1.2341, 2.9961}, 1), "between 1.24 m and 2.99 m");
  EXPECT_EQ(RangeText({1.2, kInfinity}, 1), "farther than 1.2 m");
  EXPECT_EQ(AtMostText(0.030888, 1), "30.8 mm");
}

// Returns a frame of 1000 x 500 elements that is focused at `focus_w`.
RenderCamera Frame(double focus_w) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {1000, 1000, 500, 250, 0, 1000, 500};
  frame.aperture.radius_w = 0.05;
  frame.focus_distance_w = focus_w;
  return frame;
}

// Returns what DensityOf() finds of such a frame if LF cameras are `distance_w` apart.
FrameForecast Forecast(uint32_t frame, double focus_w, double distance_w,
                       const DepthRange& depths) {
  FrameForecast forecast;
  forecast.frame = {frame};
  forecast.density.camera_distance_w = distance_w;
  forecast.density.depths = depths;
  const auto delta = [&](double z) { return 1000 * distance_w * std::abs(1 / z - 1 / focus_w); };
  forecast.density.near_displacement_px = delta(depths.near_w);
  forecast.density.far_displacement_px = delta(depths.far_w);
  forecast.density.coverage.fitting_diameter_w = 0.1 * frame;
  return forecast;
}

TEST(ForecastAdvice, EachChangeAloneRemovesTheDoubleEdges) {
  CameraPath path;
  path.cameras = {Frame(1.5), Frame(1.2)};
  PreprocessReport report;
  const DepthRange depths{1, 1.5};
  report.frames = {Forecast(1, 1.5, 0.01, depths), Forecast(2, 1.2, 0.01, depths)};
  EXPECT_GT(report.frames[0].density.near_displacement_px, kDoubleEdge_px);
  const ForecastAdvice advice = AdviceOf(report, path, true);
  ASSERT_TRUE(advice.focus);
  const auto delta = [](double z, double focus_w, double f_px) {
    return f_px * 0.01 * std::abs(1 / z - 1 / focus_w);
  };
  for (const double focus_w : {advice.focus->near_w, advice.focus->far_w})
    for (const double z : {depths.near_w, depths.far_w})
      EXPECT_LT(delta(z, focus_w, 1000), kDoubleEdge_px) << focus_w;
  // The first frame is the worst.
  for (const double z : {advice.depths.near_w, advice.depths.far_w})
    EXPECT_NEAR(delta(z, 1.5, 1000), 0.98 * kDoubleEdge_px, 1e-9);
  EXPECT_LT(delta(depths.near_w, 1.5, advice.width_px), kDoubleEdge_px);
  EXPECT_EQ(advice.height_px, 500 * advice.width_px / 1000);
  EXPECT_NEAR(advice.largest_aperture_w, 0.1, 1e-12);
}

TEST(ForecastAdvice, NoFocusIsAdvisedForUnknownOrDeepScenes) {
  CameraPath path;
  path.cameras = {Frame(1.5)};
  PreprocessReport report;
  report.frames = {Forecast(1, 1.5, 0.01, {1, 1.5})};
  EXPECT_FALSE(AdviceOf(report, path, false).focus);
  report.frames = {Forecast(1, 1.5, 0.01, {0.5, 10})};
  EXPECT_FALSE(AdviceOf(report, path, true).focus);
}

}  // namespace
}  // namespace lf
