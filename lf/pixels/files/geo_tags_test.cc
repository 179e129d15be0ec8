// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/geo_tags.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/pixels/files/test_geo_tiff.h"

namespace lf {
namespace {

GeoTags TagsOf(const GeoTiffText& file) {
  const auto tags = ReadGeoTagsBytes(file.Bytes(), "a.tif");
  EXPECT_TRUE(tags) << tags.error().message;
  return tags ? *tags : GeoTags();
}

TEST(GeoTags, ScaleAndTiePointPlaceTheMiddleOfTheFirstPixel) {
  // The pixel position (2, 3) is at east 500 and north 800; pixels are 0.5 wide and 0.25 high.
  const auto area =
      TagsOf(GeoTiffText().Doubles(33550, {0.5, 0.25, 0}).Doubles(33922, {2, 3, 0, 500, 800, 0}));
  EXPECT_EQ((*area.first_pixel)[0], 500 - 2 * 0.5 + 0.25);
  EXPECT_EQ((*area.first_pixel)[1], 800 + 3 * 0.25 - 0.125);
  EXPECT_EQ((*area.pixel_size)[0], 0.5);
  EXPECT_EQ((*area.pixel_size)[1], 0.25);
  EXPECT_FALSE(area.nodata || area.is_geographic || area.linear_unit != 0);
}

TEST(GeoTags, KeysStatePointsDegreesAndUnits) {
  const auto tags = TagsOf(GeoTiffText()
                               .Doubles(33550, {0.5, 0.25, 0})
                               .Doubles(33922, {0, 0, 0, 500, 800, 0})
                               .Keys({1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 2, 3076, 0, 1, 9002})
                               .Nodata("-9999"));
  EXPECT_EQ((*tags.first_pixel)[0], 500);
  EXPECT_EQ((*tags.first_pixel)[1], 800);
  EXPECT_TRUE(tags.is_geographic);
  EXPECT_EQ(tags.linear_unit, 9002);
  EXPECT_EQ(tags.nodata, -9999);
}

TEST(GeoTags, ATransformationThatOnlyScalesAndMovesIsAScaleAndATiePoint) {
  std::vector<double> matrix = {2, 0, 0, 100, 0, -3, 0, 200, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto tags = TagsOf(GeoTiffText().Doubles(34264, matrix));
  EXPECT_EQ((*tags.first_pixel)[0], 101);
  EXPECT_EQ((*tags.first_pixel)[1], 198.5);
  EXPECT_EQ((*tags.pixel_size)[1], 3);
  matrix[1] = 0.1;
  const auto turned = ReadGeoTagsBytes(GeoTiffText().Doubles(34264, matrix).Bytes(), "a.tif");
  ASSERT_FALSE(turned);
  EXPECT_NE(turned.error().message.find("a.tif: GeoTIFF tags: ModelTransformationTag turns"),
            std::string::npos)
      << turned.error().message;
}

TEST(GeoTags, FilesWithoutTagsStateNothing) {
  EXPECT_FALSE(TagsOf(GeoTiffText()).first_pixel);
  const auto png = ReadGeoTagsBytes("\x89PNG\r\n", "a.png");
  ASSERT_TRUE(png);
  EXPECT_FALSE(png->first_pixel || png->pixel_size || png->nodata);
}

TEST(GeoTags, WrongTagsAreErrorsThatNameThem) {
  const auto expect = [](const GeoTiffText& file, const std::string& words) {
    const auto tags = ReadGeoTagsBytes(file.Bytes(), "a.tif");
    ASSERT_FALSE(tags) << words;
    EXPECT_NE(tags.error().message.find(words), std::string::npos) << tags.error().message;
  };
  expect(GeoTiffText().Doubles(33922, {0, 0, 0, 1, 2, 0}), "no ModelPixelScaleTag");
  expect(GeoTiffText().Doubles(33550, {1, 1, 0}).Doubles(33922, {0, 0, 0, 1, 2}), "multiple of 6");
  expect(GeoTiffText().Doubles(33550, {1, -1, 0}), "1 x -1 map units");
  expect(GeoTiffText().Doubles(34264, {1, 2, 3}), "expected 16");
  expect(GeoTiffText().Doubles(34735, {1, 1}), "the TIFF tag 34735 has not the type");
  expect(GeoTiffText().Nodata("unknown"), "42113");
  std::string cut = GeoTiffText().Doubles(33550, {1, 1, 0}).Bytes();
  EXPECT_FALSE(ReadGeoTagsBytes(cut.substr(0, cut.size() / 2), "a.tif"));
}

}  // namespace
}  // namespace lf
