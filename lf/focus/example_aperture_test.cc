// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/example_aperture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lf/focus/best_depths.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

constexpr double kGridFocal_px = 300;

// Returns a grid of side x side parallel cameras, `spacing_w` apart.
LightField GridAhead(int side, double spacing_w) {
  LightField field;
  field.intrinsics = {{kGridFocal_px, kGridFocal_px, 100, 80, 0, 200, 160}};
  for (int i = 0; i < side * side; ++i) {
    const Vec3 at(spacing_w * (i % side - side / 2), spacing_w * (i / side - side / 2), 0);
    field.cameras.push_back({*LookAlong(at, {0, 0, 1}, {0, -1, 0}), 0, 1});
    field.image_names.emplace_back("none.png");
  }
  return field;
}

// Returns the aperture for a focus at depth 1, seen from the middle, if 100 textured places have
// these depths; the depths of the other places are unknown.
ExampleAperture ApertureOf(const LightField& field, const std::vector<double>& depths_w) {
  ExampleFocus focus{1, "as a test says"};
  for (const double depth_w : depths_w) focus.places.per_w.push_back(1 / depth_w);
  focus.places.count = 100;
  const LfImageId middle{static_cast<uint32_t>(field.size() / 2)};
  return ChooseAperture(field, field.Camera(middle), focus, MedianSpacing(field));
}

std::vector<double> PlacesAt(size_t count, double depth_w) {
  return std::vector<double>(count, depth_w);
}

TEST(ChooseAperture, OpensWhereCopiesAreNear) {
  EXPECT_DOUBLE_EQ(ApertureOf(GridAhead(9, 0.01), PlacesAt(100, 1)).spacings, 8);
  const double copies_px = 6;  // 300 * 0.02 * (1 - 0)
  EXPECT_NEAR(ApertureOf(GridAhead(9, 0.02), PlacesAt(100, INFINITY)).spacings, 8 * 3 / copies_px,
              1e-9);
}

TEST(ChooseAperture, PlacesWithoutAgreementCountAsFarApart) {
  const LightField field = GridAhead(9, 0.01);
  EXPECT_GT(ApertureOf(field, PlacesAt(80, 1)).spacings, 6);
  const ExampleAperture sharp = ApertureOf(field, PlacesAt(70, 1));
  EXPECT_LT(sharp.spacings, 0.01);
  EXPECT_NE(sharp.reason.find("only 70 of 100 textured places: it is not sure"), std::string::npos);
  EXPECT_FALSE(sharp.copies.empty());
  std::vector<double> some_wrong = PlacesAt(70, 1);
  some_wrong.resize(76, 0.05);  // false matches do not make it sure
  EXPECT_NE(ApertureOf(field, some_wrong).reason.find("it is not sure"), std::string::npos);
  EXPECT_EQ(ApertureOf(field, PlacesAt(90, 0.1)).reason.find("not sure"), std::string::npos);
}

TEST(ChooseAperture, NoLensIsWiderThanAQuarterOfTheFocusDistance) {
  const ExampleAperture limited = ApertureOf(GridAhead(9, 0.04), PlacesAt(100, 1));
  EXPECT_NEAR(limited.spacings * 0.04, kWidestLens, 1e-9);
  EXPECT_NE(limited.reason.find("it is limited to 0.25"), std::string::npos);
  const ExampleAperture sharp = ApertureOf(GridAhead(9, 0.12), PlacesAt(100, 1));
  EXPECT_LT(sharp.spacings, 0.01);
}

TEST(ChooseAperture, AnOpenLensHoldsSixCameras) {
  const ExampleAperture least = ApertureOf(GridAhead(9, 0.045), PlacesAt(100, INFINITY));
  EXPECT_NEAR(least.spacings, 2 * std::sqrt(2.) * 1.02, 1e-9);  // copies 13.5 px apart
  EXPECT_NEAR(least.spacings, least.least_spacings, 1e-9);
  const ExampleAperture sharp = ApertureOf(GridAhead(2, 0.01), PlacesAt(100, 1));
  EXPECT_LT(sharp.spacings, 0.01);
  EXPECT_NE(sharp.reason.find("fewer than 6 LF cameras"), std::string::npos);
}

TEST(ChooseAperture, SixCamerasStandAtSixPositions) {
  LightField twice = GridAhead(9, 0.045);
  const LightField once = twice;
  for (const LfCamera& camera : once.cameras) twice.cameras.push_back(camera);
  twice.image_names.resize(twice.cameras.size());
  ExampleFocus focus{1, "as a test says"};
  focus.places.per_w.assign(100, 0);
  focus.places.count = 100;
  const PinholeCamera middle = once.Camera({40});
  EXPECT_NEAR(ChooseAperture(twice, middle, focus, 0.045).spacings,
              ChooseAperture(once, middle, focus, 0.045).spacings, 1e-9);
}

TEST(ChooseAperture, WithoutTextureACopyIsAssumedBeforeTheFocus) {
  const ExampleFocus focus{1, "as given"};
  const auto aperture = [&](double spacing_w) {
    const LightField grid = GridAhead(9, spacing_w);
    return ChooseAperture(grid, grid.Camera({40}), focus, spacing_w);
  };
  EXPECT_NEAR(aperture(0.02).spacings, 8, 1e-9);  // copies 2 px apart
  EXPECT_LT(aperture(0.2).spacings, 0.01);        // copies 20 px apart
}

TEST(PutSubjectFirst, TheNearestLargeClusterIsTheSubject) {
  std::vector<SubjectDepth> depths = {{3, 0.6, 90}, {1, 0.2, 20}, {0.5, 0.05, 5}};
  PutSubjectFirst(&depths);
  EXPECT_EQ(depths[0].distance_w, 1);
  EXPECT_EQ(depths[1].distance_w, 3);
  std::vector<SubjectDepth> near_one_another = {{3, 0.6, 90}, {2.7, 0.3, 40}};
  PutSubjectFirst(&near_one_another);
  EXPECT_EQ(near_one_another[0].distance_w, 3);
}

}  // namespace
}  // namespace lf
