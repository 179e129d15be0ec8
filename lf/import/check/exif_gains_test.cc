// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/exif_gains.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

LightField FieldOfSize(size_t count) {
  LightField field;
  field.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100});
  field.folder = "capture";
  for (size_t i = 0; i < count; ++i) {
    field.cameras.emplace_back();
    field.cameras.back().gain = 7;
    field.image_names.push_back(std::to_string(i) + ".jpg");
  }
  return field;
}

std::vector<StatedExposure> Stated(const std::vector<ExposureFacts>& facts) {
  std::vector<StatedExposure> stated;
  for (uint32_t i = 0; i < facts.size(); ++i) stated.push_back({LfImageId{i}, facts[i], ""});
  return stated;
}

std::vector<float> Gains(const LightField& field) {
  std::vector<float> gains;
  for (const LfCamera& camera : field.cameras) {
    EXPECT_TRUE(camera.gain.are_equal());
    gains.push_back(camera.gain[0]);
  }
  return gains;
}

void ExpectError(const std::vector<StatedExposure>& stated, const std::vector<std::string>& words) {
  LightField field = FieldOfSize(stated.size());
  const Result<ExifGains> gains = GainFromExif(stated, &field);
  ASSERT_FALSE(gains);
  for (const std::string& word : words)
    EXPECT_NE(gains.error().message.find(word), std::string::npos) << gains.error().message;
  EXPECT_EQ(field.cameras[0].gain, ChannelGains(7));
}

TEST(ExifGains, MakeAllAsBrightAsTheMedianOne) {
  LightField field = FieldOfSize(5);
  const ExifGains found =
      GainFromExif(
          Stated(
              {{0.01, 4, 100}, {0.04, 4, 100}, {0.0025, 4, 100}, {0.01, 8, 100}, {0.01, 4, 400}}),
          &field)
          .value();
  EXPECT_EQ(Gains(field), (std::vector<float>{1, 0.25F, 4, 4, 0.25F}));
  EXPECT_EQ(found.reference.value, 0U);
  EXPECT_EQ(found.least_gain, 0.25F);
  EXPECT_EQ(found.most_gain, 4);
  EXPECT_EQ(field.encoding.max_radiance, 4);
}

TEST(ExifGains, OfTwoInTheMiddleTheDarkerIsTheReference) {
  LightField field = FieldOfSize(2);
  GainFromExif(Stated({{0.04, 4, 100}, {0.01, 4, 100}}), &field).value();
  EXPECT_EQ(Gains(field), (std::vector<float>{0.25F, 1}));
}

TEST(ExifGains, ALensThatTellsNoFNumberIsTakenToKeepIt) {
  LightField field = FieldOfSize(2);
  const ExifGains found = GainFromExif(Stated({{0.04, {}, 100}, {0.01, {}, 100}}), &field).value();
  EXPECT_FALSE(found.has_f_numbers);
  EXPECT_EQ(Gains(field), (std::vector<float>{0.25F, 1}));
  ExpectError(Stated({{0.04, {}, 100}, {0.01, 4, 100}}),
              {"capture/0.jpg", "states no f-number (", "1 of 2"});
}

TEST(ExifGains, AnImageWithoutExposureIsNamed) {
  ExpectError(
      Stated({{0.04, 4, 100}, {0.04, 4, {}}, {}}),
      {"capture/1.jpg", "states no ISO sensitivity (", "2 of 3", "Exif", "{match_exposure}"});
  ExpectError(Stated({{0.04, 4, 100}, {}}),
              {"capture/1.jpg", "no exposure time and no f-number and no ISO sensitivity"});
  std::vector<StatedExposure> stated = Stated({{0.04, 4, 100}, {0.04, 4, 100}});
  stated[1].fault = "capture/1.jpg: cannot be read";
  ExpectError(stated, {"capture/1.jpg: cannot be read", "{exclude}"});
}

TEST(ExifGains, GainsThatNoCameraNeedsAreRefused) {
  ExpectError(Stated({{1, 4, 100}, {1, 4, 100}, {1e-9, 4, 100}}), {"capture/2.jpg", "1e-09 times"});
}

}  // namespace
}  // namespace lf
