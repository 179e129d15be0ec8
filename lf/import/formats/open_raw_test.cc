// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "lf/core/file.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/light_field/model/raw_encoding.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/test_dng.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

// A light field of one DNG file.
class RawEncodingTest : public FolderTest {
 protected:
  static TestDng Dng(const std::string& pattern = "GRBG") {
    TestDng dng(NoiseImage<uint16_t>(24, 22, 1), pattern);
    dng.Long(50714, {256}).Long(50717, {4095}).Short(50778, {21});
    dng.Fractions(50728, 5, {{1, 2}, {1, 1}, {4, 5}});
    dng.Fractions(50721, 10,
                  {{1, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 1}});
    return dng;
  }
  Result<LightField> Open(const TestDng& dng, const std::string& keys = "",
                          const OpenOptions& options = {}) {
    const std::string text = "{\"fl_x\": 20, " + keys + R"("frames": [{"file_path": "a.dng",
        "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})";
    EXPECT_TRUE(WriteFileAtomically(folder_ / "transforms.json", text));
    EXPECT_TRUE(WriteFileAtomically(folder_ / "a.dng", dng.File()));
    return OpenLightField(folder_, options);
  }
};

TEST_F(RawEncodingTest, TheFirstFileTellsWhatIsNotStated) {
  const Result<LightField> light_field = Open(Dng());
  ASSERT_TRUE(light_field) << light_field.error().message;
  const RadianceEncoding& encoding = light_field->encoding;
  EXPECT_EQ(light_field->intrinsics[0].height_px, 22);
  EXPECT_EQ(encoding.bayer, BayerPattern::kGrbg);
  EXPECT_EQ(encoding.transfer, Transfer::kLinear);
  EXPECT_EQ(encoding.black_level, 256);
  EXPECT_EQ(encoding.white_level, 4095);
  EXPECT_EQ(encoding.pedestal, 1024);
  EXPECT_EQ(encoding.max_radiance, 1);
  EXPECT_NEAR(encoding.white_balance[0], 2, 1e-6);
  EXPECT_NE(encoding.linear_srgb_from_camera, Mat3::Identity());
}

TEST_F(RawEncodingTest, WhatIsStatedGoesFirst) {
  const Result<LightField> light_field =
      Open(Dng(), R"("lf_bayer": "RGGB", "lf_black_level": 0, "lf_white_balance": [1, 1, 3],)");
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->encoding.bayer, BayerPattern::kRggb);
  EXPECT_EQ(light_field->encoding.black_level, 0);
  EXPECT_EQ(light_field->encoding.white_level, 4095);
  EXPECT_EQ(light_field->encoding.pedestal, 0);
  EXPECT_EQ(light_field->encoding.white_balance, (std::array<double, 3>{1, 1, 3}));
  EXPECT_NE(light_field->encoding.linear_srgb_from_camera, Mat3::Identity());
}

TEST_F(RawEncodingTest, WrittenDownItNeedsNoFile) {
  const Result<LightField> opened = Open(Dng());
  ASSERT_TRUE(opened && WriteTransformsJson(*opened, folder_ / "transforms.json"));
  std::filesystem::remove(folder_ / "a.dng");
  const Result<LightField> again = OpenLightField(folder_);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->encoding.bayer, BayerPattern::kGrbg);
  EXPECT_EQ(again->encoding.white_level, 4095);
  EXPECT_EQ(again->encoding.white_balance, opened->encoding.white_balance);
  EXPECT_EQ(again->encoding.linear_srgb_from_camera, opened->encoding.linear_srgb_from_camera);
}

TEST_F(RawEncodingTest, APatternThatNobodyTellsIsAskedFor) {
  const Result<LightField> untold = Open(Dng("RGBG"));
  ASSERT_FALSE(untold);
  EXPECT_NE(untold.error().message.find("{lfimport bayer RGGB}"), std::string::npos);
  EXPECT_NE(untold.error().message.find("a.dng"), std::string::npos);
  const Result<LightField> told = Open(Dng("RGBG"), "", {.bayer = BayerPattern::kBggr});
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_EQ(told->encoding.bayer, BayerPattern::kBggr);
  EXPECT_EQ(told->encoding.black_level, 256);
}

TEST_F(RawEncodingTest, ASensorWithoutColourFilterIsGreyLight) {
  TestDng dng(NoiseImage<uint16_t>(24, 22, 1), "RGGB");
  dng.Short(262, {34892}).Without(33421).Without(33422).Long(50714, {256}).Long(50717, {4095});
  const Result<LightField> light_field = Open(dng);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->encoding.bayer, BayerPattern::kNone);
  EXPECT_EQ(light_field->encoding.transfer, Transfer::kLinear);
  EXPECT_EQ(light_field->encoding.black_level, 256);
  ASSERT_TRUE(WriteTransformsJson(*light_field, folder_ / "transforms.json"));
  const Result<LightField> again = OpenLightField(folder_);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->encoding.white_level, 4095);
}

TEST_F(RawEncodingTest, AFirstFileThatTellsNothingIsAnError) {
  ASSERT_TRUE(Open(Dng()));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.dng", "no picture"));
  LightField light_field;
  light_field.folder = folder_;
  light_field.image_names = {"a.dng"};
  const auto broken = RawFactsOfFirstImage(light_field);
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().message.find("a.dng"), std::string::npos);
  EXPECT_NE(broken.error().message.find("lf_white_level"), std::string::npos);
  light_field.image_names = {"a.png"};
  const auto other = RawFactsOfFirstImage(light_field);
  ASSERT_TRUE(other);
  EXPECT_FALSE(*other);
}

TEST_F(RawEncodingTest, FoldersWithoutAWordOnPixelsAreCompleted) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a_0_0_0.0_5.0_30_36.dng", Dng("BGGR").File()));
  const Result<LightField> light_field = OpenLightField(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->encoding.bayer, BayerPattern::kBggr);
  EXPECT_EQ(light_field->encoding.white_level, 4095);
}

TEST(RawName, IsToldByItsExtension) {
  EXPECT_TRUE(IsRawName("a/b.DNG"));
  EXPECT_TRUE(IsRawName("b.nef"));
  EXPECT_TRUE(IsRawName("IMG_0001.CR3"));
  EXPECT_FALSE(IsRawName("dng"));
  EXPECT_FALSE(IsRawName("b.dng.tif"));
}

}  // namespace
}  // namespace lf
