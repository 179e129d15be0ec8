// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/colour_profile.h"

#include <gtest/gtest.h>
#include <lcms2.h>

#include <string>

#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

// Returns an RGB profile with the curve of sRGB and these primaries.
std::string ProfileOf(const cmsCIExyYTRIPLE& primaries, const char* name) {
  const cmsCIExyY d65 = {0.3127, 0.3290, 1};
  const cmsFloat64Number parameters[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  cmsToneCurve* const curve = cmsBuildParametricToneCurve(nullptr, 4, parameters);
  cmsToneCurve* const curves[] = {curve, curve, curve};
  const cmsHPROFILE profile = cmsCreateRGBProfile(&d65, &primaries, curves);
  cmsMLU* const text = cmsMLUalloc(nullptr, 1);
  cmsMLUsetASCII(text, "en", "US", name);
  cmsWriteTag(profile, cmsSigProfileDescriptionTag, text);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string icc(size, '\0');
  cmsSaveProfileToMem(profile, icc.data(), &size);
  cmsMLUfree(text);
  cmsCloseProfile(profile);
  cmsFreeToneCurve(curve);
  return icc;
}

const std::string& DisplayP3() {
  static const std::string icc =
      ProfileOf({{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}}, "Display P3");
  return icc;
}
const std::string& Srgb() {
  static const std::string icc = ProfileOf(
      {{0.640, 0.330, 1}, {0.300, 0.600, 1}, {0.150, 0.060, 1}}, "sRGB as a camera has it");
  return icc;
}

TEST(ColourProfile, NamesAreThoseOfTheFile) {
  EXPECT_EQ(NameOfProfile(DisplayP3()), "Display P3");
  EXPECT_EQ(NameOfProfile("no profile"), "");
  EXPECT_EQ(NameOfProfile(""), "");
}

TEST(ColourProfile, OnlyOtherColoursAreConverted) {
  EXPECT_TRUE(IsOtherThanSrgb(DisplayP3()));
  EXPECT_FALSE(IsOtherThanSrgb(Srgb()));
  EXPECT_FALSE(IsOtherThanSrgb(""));
  EXPECT_FALSE(IsOtherThanSrgb(DisplayP3().substr(0, 200)));
}

TEST(ColourProfile, ColoursOfDisplayP3BecomeThoseOfSrgb) {
  // Known values: the sRGB red is (234, 51, 35) in Display P3, and greys are the same in both.
  Image<uint8_t> image(4, 1, 4);
  const uint8_t colours[4][4] = {
      {234, 51, 35, 7}, {128, 128, 128, 0}, {255, 255, 255, 255}, {0, 255, 0, 9}};
  for (int x = 0; x < 4; ++x)
    for (int c = 0; c < 4; ++c) image.at(x, 0, c) = colours[x][c];
  StoredImage stored = image;
  EXPECT_TRUE(ConvertToSrgb(DisplayP3(), &stored));
  const auto& converted = std::get<Image<uint8_t>>(stored);
  const uint8_t expected[4][4] = {
      {255, 0, 0, 7}, {128, 128, 128, 0}, {255, 255, 255, 255}, {0, 255, 0, 9}};
  for (int x = 0; x < 4; ++x)
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(converted.at(x, 0, c), expected[x][c], 1) << x << c;
  StoredImage untouched = image;
  EXPECT_FALSE(ConvertToSrgb(Srgb(), &untouched));
}

TEST(ColourProfile, SixteenBitsKeepTheirPrecision) {
  Image<uint16_t> image(1, 1, 3);
  image.at(0, 0, 0) = 30000;
  image.at(0, 0, 1) = image.at(0, 0, 2) = 20000;
  StoredImage stored = image;
  EXPECT_TRUE(ConvertToSrgb(DisplayP3(), &stored));
  const auto& converted = std::get<Image<uint16_t>>(stored);
  EXPECT_NEAR(converted.at(0, 0, 0), 31790, 150);  // stronger in sRGB's smaller range
  EXPECT_LT(converted.at(0, 0, 1), 20000);
  StoredImage floats = Image<float>(2, 2, 3);
  EXPECT_FALSE(ConvertToSrgb(DisplayP3(), &floats));
  StoredImage grey = Image<uint8_t>(2, 2, 1);
  EXPECT_FALSE(ConvertToSrgb(DisplayP3(), &grey));
}

}  // namespace
}  // namespace lf
