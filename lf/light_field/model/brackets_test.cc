// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/brackets.h"

#include <gtest/gtest.h>

#include "lf/camera/vignetting.h"

namespace lf {
namespace {

using Counts = std::vector<uint32_t>;

LightField Empty() {
  LightField field;
  field.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100});
  field.encoding.masks_clipped = true;
  return field;
}

void Add(double x, float gain, LightField* field) {
  LfCamera camera;
  camera.cam_from_world.translation = Vec3(-x, 0, 0);
  camera.gain = gain;
  field->cameras.push_back(camera);
  field->image_names.push_back(std::to_string(field->size()) + ".png");
}

// Returns `count` poses at x = 1000, 1001 ...; each pose has one LF image for each gain.
LightField Poses(int count, const std::vector<float>& gains) {
  LightField field = Empty();
  for (int i = 0; i < count; ++i)
    for (const float gain : gains) Add(1000 + i, gain, &field);
  return field;
}

std::vector<bool> Masked(const LightField& field) {
  std::vector<bool> masked;
  for (const LfCamera& camera : field.cameras) masked.push_back(camera.masks_clipped);
  return masked;
}

TEST(Brackets, TheDarkestOfEachPoseKeepsItsClippedPixels) {
  LightField field = Poses(2, {1, 0.25F, 4});
  EXPECT_EQ(ApplyBrackets(&field), 4U);
  EXPECT_EQ(Masked(field), (std::vector<bool>{true, true, false, true, true, false}));
}

TEST(Brackets, AnImageWithoutADarkerOneOfItsPoseIsNotMasked) {
  LightField field = Poses(2, {1});
  Add(1001, 0.25F, &field);  // brighter than the second LF image, at the same position
  Add(1005, 0.01F, &field);  // the only one at its position, although brighter than all
  EXPECT_EQ(ApplyBrackets(&field), 1U);
  EXPECT_EQ(Masked(field), (std::vector<bool>{false, false, true, false}));
  EXPECT_EQ(field.cameras[1].brighter, 2U);
  EXPECT_EQ(field.cameras[3].brighter, LfCamera::kNone);
}

TEST(Brackets, NearlyEqualGainsAreOneExposure) {
  LightField field = Poses(3, {1, 1.05F});
  EXPECT_EQ(ApplyBrackets(&field), 0U);
  for (const LfCamera& camera : field.cameras) EXPECT_EQ(camera.brighter, LfCamera::kNone);
  LightField twice = Poses(1, {1, 1, 4, 4});
  EXPECT_EQ(ApplyBrackets(&twice), 2U);
  EXPECT_EQ(Masked(twice), (std::vector<bool>{true, true, false, false}));
}

TEST(Brackets, EachKnowsTheNextBrighterOne) {
  constexpr uint32_t kNone = LfCamera::kNone;
  LightField field = Poses(1, {1, 0.25F, 4, 0.26F});
  Add(1005, 0.01F, &field);
  EXPECT_EQ(ApplyBrackets(&field), 3U);
  Counts brighter;
  for (const LfCamera& camera : field.cameras) brighter.push_back(camera.brighter);
  EXPECT_EQ(brighter, (Counts{3, kNone, 0, kNone, kNone}));
}

TEST(Brackets, NothingIsDecidedWhereClippedPixelsAreKept) {
  LightField field = Poses(2, {1, 0.25F, 4});
  ApplyBrackets(&field);
  field.encoding.masks_clipped = false;
  EXPECT_EQ(ApplyBrackets(&field), 0U);
  EXPECT_EQ(Masked(field), std::vector<bool>(6, false));
  for (const LfCamera& camera : field.cameras) EXPECT_EQ(camera.brighter, LfCamera::kNone);
}

TEST(Brackets, PosesThatDifferByRoundingAreOneAndBecomeEqual) {
  LightField field = Poses(1000, {1});
  for (int i = 0; i < 1000; ++i) Add(1000 + i + 1e-7, 4, &field);
  EXPECT_EQ(ApplyBrackets(&field), 1000U);
  for (size_t i = 0; i < 1000; ++i)
    EXPECT_EQ(field.cameras[i].cam_from_world.translation,
              field.cameras[1000 + i].cam_from_world.translation);
}

TEST(Brackets, OnePoseIsOnePlaceOneDirectionAndOneView) {
  LightField field = Poses(3, {1});
  Add(1000, 4, &field);
  Add(1001, 4, &field);
  Add(1002 + 1e-6, 4, &field);  // another pose, 1e-6 beside the first
  EXPECT_EQ(FirstOfPose(field), (Counts{0, 1, 2, 0, 1, 5}));
  field.cameras[3].cam_from_world.rotation =
      Eigen::AngleAxisd(0.01, Vec3::UnitX()).toRotationMatrix();
  EXPECT_EQ(FirstOfPose(field), (Counts{0, 1, 2, 3, 1, 5}));
  field.intrinsics.push_back(field.intrinsics[0]);
  field.intrinsics[1].fx_px *= 2;  // another lens
  field.cameras[4].intrinsics_index = 1;
  EXPECT_EQ(FirstOfPose(field)[4], 4U);
}

TEST(Brackets, TheExposureIsTheMeanOfTheChannels) {
  LfCamera camera;
  camera.gain = {4, 1, 2};
  EXPECT_NEAR(ExposureOf(camera), 0.5, 1e-6);
}

TEST(Brackets, TheBrightestWhiteHasTheLargestGainAndTheLeastFalloff) {
  LightField field = Poses(1, {1, 4, 0.25F});
  RadianceEncoding encoding;
  EXPECT_EQ(BrightestWhite(field, encoding), 4);
  field.intrinsics[0].vignetting.v = {-0.5, 0, 0};
  const double least_share = FalloffRangeOf(field.intrinsics[0]).min;
  EXPECT_NEAR(BrightestWhite(field, encoding), 4 / least_share, 0.01);
  EXPECT_GE(BrightestWhite(field, encoding), 4 / least_share);
  field.intrinsics[0].vignetting = {};
  encoding.transfer = Transfer::kResponse;
  encoding.response = {0, 1.5};
  EXPECT_EQ(BrightestWhite(field, encoding), 6);
  field.image_names[1] = "1.exr";
  EXPECT_EQ(BrightestWhite(field, encoding), 1.5);
  for (LfCamera& camera : field.cameras) camera.gain = 0.25F;
  EXPECT_EQ(BrightestWhite(field, encoding), 1);
}

TEST(Brackets, ThereIsRoomForTheLargestGain) {
  LightField field = Poses(1, {1, 4, 0.25F});
  MakeRoomForGains(&field);
  EXPECT_EQ(field.encoding.max_radiance, 4);
  field.image_names[0] = "0.exr";
  field.cameras[0].gain = 100;
  MakeRoomForGains(&field);
  EXPECT_EQ(field.encoding.max_radiance, 4);
}

}  // namespace
}  // namespace lf
