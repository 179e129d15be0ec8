// SPDX-License-Identifier: Apache-2.0
#include "lf/import/report/exposure_steps.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lf {
namespace {

// Returns LF images, two of each pose, the second of which is `gain` times as dark.
LightField Pairs(float gain) {
  LightField field;
  field.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100});
  field.folder = "/nowhere";
  for (int i = 0; i < 6; ++i) {
    LfCamera camera;
    camera.cam_from_world.translation = Vec3(i / 2, 0, 0);
    if (i % 2 == 1) camera.gain = gain;
    field.cameras.push_back(camera);
    field.image_names.push_back(std::to_string(i) + ".jpg");
  }
  return field;
}

std::vector<std::string> Kinds(const CaptureReport& report) {
  std::vector<std::string> kinds;
  for (const CaptureWarning& warning : report.warnings) kinds.push_back(warning.kind);
  return kinds;
}

TEST(ExposureSteps, OnlyFilesThatShareAPoseAreAskedWithoutGains) {
  LightField field = Pairs(4);
  field.cameras[5].cam_from_world.translation.x() = 9;
  std::vector<double> lights;
  ThreadPool pool(1);
  const auto gains = StateBrackets({}, pool, &field, &lights);
  ASSERT_TRUE(gains);
  EXPECT_FALSE(*gains);
  EXPECT_EQ(lights.size(), 6u);
  EXPECT_FALSE(field.encoding.masks_clipped);
}

TEST(ExposureSteps, FilesMustBeReadForTheirGains) {
  LightField field = Pairs(1);
  std::vector<double> lights;
  ThreadPool pool(1);
  const auto gains = StateBrackets({.gain_from_exif = true}, pool, &field, &lights);
  ASSERT_FALSE(gains);
  EXPECT_EQ(gains.error().kind, ErrorKind::kInput);
}

TEST(ExposureSteps, MaskingNeedsADarkerImageOfThePose) {
  ThreadPool pool(1);
  for (const float gain : {4.F, 1.F}) {
    LightField field = Pairs(gain);
    std::vector<double> lights;
    const ExposureSteps steps{.mask_clipped = true};
    ASSERT_TRUE(StateBrackets(steps, pool, &field, &lights));
    EXPECT_TRUE(field.encoding.masks_clipped);
    CaptureReport report;
    WarnOfBrackets(steps, std::nullopt, &field, &report);
    EXPECT_EQ(Kinds(report),
              gain == 1 ? std::vector<std::string>{"no-brackets"} : std::vector<std::string>{});
  }
}

TEST(ExposureSteps, WhatMatchedGainsExplainIsNoWarning) {
  LightField field = Pairs(4);
  field.encoding.masks_clipped = true;
  ExifGains gains;
  gains.has_f_numbers = false;
  CaptureReport report;
  report.warnings = {
      {"brackets", "", 6, {}}, {"repeated-positions", "", 6, {}}, {"other", "", 6, {}}};
  WarnOfBrackets({.match = true, .mask_clipped = true}, gains, &field, &report);
  EXPECT_EQ(Kinds(report), (std::vector<std::string>{"other", "no-f-number"}));
  ASSERT_TRUE(report.brackets);
  EXPECT_EQ(report.brackets->pose_count, 3u);
}

}  // namespace
}  // namespace lf
