// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/camera_facts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/camera/path/test_path.h"
#include "lf/camera/thin_lens.h"

namespace lf {
namespace {

std::vector<double> Fact(const RenderCamera& camera, const std::string& name) {
  for (const CameraFact& fact : CameraFacts(camera, {7}))
    if (fact.name == name) return fact.values;
  ADD_FAILURE() << name;
  return {0};
}

TEST(CameraFacts, AreInTheUnitsOfTheirNames) {
  TestPath path;
  path.clock += "unit_m: 0.01\n";
  path.focus = "focus_distance: 200, focus_tilt_deg: {vertical: 30}";
  const RenderCamera camera = path.At(11);
  EXPECT_EQ(Fact(camera, "frame")[0], 7);
  EXPECT_NEAR(Fact(camera, "time_s")[0], 1, 1e-12);
  EXPECT_NEAR(Fact(camera, "focal_length_mm")[0], 50, 1e-9);
  EXPECT_NEAR(Fact(camera, "aperture_diameter_mm")[0], 4, 1e-9);
  EXPECT_NEAR(Fact(camera, "f_number")[0], 12.5, 1e-9);
  EXPECT_NEAR(Fact(camera, "focus_distance_w")[0], 200, 1e-9);
  EXPECT_NEAR(Fact(camera, "focus_tilt_deg")[1], 30, 1e-9);
  // The plate is 36 mm wide and half as high, at a focal length of 50 mm.
  EXPECT_NEAR(Fact(camera, "field_of_view_deg")[0], 39.5978, 1e-4);
  EXPECT_NEAR(std::tan(RadiansFromDegrees(Fact(camera, "field_of_view_deg")[1] / 2)), 9.0 / 50,
              1e-9);
}

TEST(CameraFacts, TheBlurIsOneElementAtTheEndsOfTheDepthOfField) {
  TestPath path;
  path.aperture = "aperture_diameter_mm: 40";
  const RenderCamera camera = path.At(1);
  const double elements_per_w = camera.pinhole.intrinsics.fx_px / camera.focus_distance_w;
  for (const double depth_w : Fact(camera, "depth_of_field_w"))
    EXPECT_NEAR(BlurOnFocusPlane(2 * camera.aperture.radius_w, camera.focus_distance_w, depth_w) *
                    elements_per_w,
                1, 1e-9);
}

TEST(CameraFacts, APinholeIsSharpEverywhere) {
  TestPath path;
  path.aperture = "aperture_diameter: 0";
  EXPECT_EQ(Fact(path.At(1), "depth_of_field_w"), (std::vector<double>{0, HUGE_VAL}));
  EXPECT_EQ(Fact(path.At(1), "f_number")[0], HUGE_VAL);
}

TEST(CameraFacts, HaveAsManyValuesAsParts) {
  for (const CameraFact& fact : CameraFacts(TestPath{}.At(1), {1}))
    EXPECT_EQ(fact.values.size(), std::max<size_t>(1, fact.parts.size())) << fact.name;
}

}  // namespace
}  // namespace lf
