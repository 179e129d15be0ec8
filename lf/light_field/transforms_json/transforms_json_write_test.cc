// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iterator>
#include <string>

#include "lf/core/file.h"
#include "lf/core/random.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class WriteTransformsJsonTest : public FolderTest {
 protected:
  LightField WrittenAndRead(const LightField& light_field) const {
    const fs::path path = folder_ / "transforms.json";
    const Result<void> written = WriteTransformsJson(light_field, path);
    EXPECT_TRUE(written) << written.error().message;
    Result<LightField> read = ReadTransformsJson(path);
    EXPECT_TRUE(read) << read.error().message;
    return read ? *std::move(read) : LightField{};
  }
};

double Number(uint64_t camera, uint64_t index) { return RandomUnit(7, camera, index) - 0.5; }

LightField RandomLightField(size_t count) {
  LightField light_field;
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Quaterniond q(Number(i, 0), Number(i, 1), Number(i, 2), Number(i, 3));
    LfCamera camera;
    camera.cam_from_world.rotation = q.normalized().toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis)
      camera.cam_from_world.translation[axis] = Number(i, 4 + axis) * std::pow(10, axis * 4 - 4);
    camera.intrinsics_index = i % 3;
    camera.gain = i % 2 ? 1.0f : 0.1f + static_cast<float>(i);
    if (i % 5 == 0) camera.gain[1] = 1.0f / 3;
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back("images/\"\u00e9\\ " + std::to_string(i) + ".png");
    light_field.mask_names.push_back(i % 4 == 2 ? "mask.png" : "");
  }
  light_field.intrinsics = {{1000.0 / 3, 500.1, 320.5, 0.1 + 0.2, 0, 640, 480},
                            {400, 400, -3, 240, 0, 1, 65536},
                            {1e-3, 1e7, 320, 240, 0, 640, 480}};
  light_field.intrinsics[2].vignetting.v = {-1.0 / 3, 0.1, -0.05};
  light_field.encoding.bayer = BayerPattern::kGrbg;
  light_field.encoding.transfer = Transfer::kLinear;
  light_field.encoding.black_level = 511.7;
  light_field.encoding.white_level = 16383;
  light_field.encoding.max_radiance = 1.1;
  light_field.encoding.pedestal = 1024;
  light_field.encoding.alpha = AlphaMeaning::kStraight;
  light_field.encoding.footprint = PixelFootprint::kPoint;
  light_field.encoding.background = {0.1, 1.0 / 3, 1};
  light_field.encoding.white_balance = {2.0 / 3, 1, 1.7};
  light_field.encoding.linear_srgb_from_camera << 1.6, -0.5, -0.1, -0.2, 1.5, -0.3, 0.0, -0.5, 1.5;
  light_field.unit_m = 0.001;
  return light_field;
}

bool SameBits(const LfCamera& a, const LfCamera& b) {
  return std::memcmp(&a.cam_from_world, &b.cam_from_world, sizeof a.cam_from_world) == 0 &&
         a.gain == b.gain;
}

TEST_F(WriteTransformsJsonTest, ReadsBackBitForBit) {
  const LightField written = RandomLightField(500);
  const LightField read = WrittenAndRead(written);
  ASSERT_EQ(read.size(), written.size());
  for (uint32_t i = 0; i < read.size(); ++i) {
    EXPECT_TRUE(SameBits(read.cameras[i], written.cameras[i])) << i;
    EXPECT_EQ(read.Camera({i}).intrinsics, written.Camera({i}).intrinsics) << i;
  }
  EXPECT_EQ(read.intrinsics.size(), 3u);
  EXPECT_EQ(read.image_names, written.image_names);
  EXPECT_EQ(read.mask_names, written.mask_names);
  EXPECT_EQ(read.folder, folder_);
  EXPECT_EQ(read.unit_m, written.unit_m);

  const RadianceEncoding& a = read.encoding;
  const RadianceEncoding& b = written.encoding;
  EXPECT_EQ(a.bayer, b.bayer);
  EXPECT_EQ(a.transfer, b.transfer);
  EXPECT_EQ(a.black_level, b.black_level);
  EXPECT_EQ(a.white_level, b.white_level);
  EXPECT_EQ(a.max_radiance, b.max_radiance);
  EXPECT_EQ(a.alpha, b.alpha);
  EXPECT_EQ(a.footprint, b.footprint);
  EXPECT_EQ(a.background, b.background);
  EXPECT_EQ(a.pedestal, b.pedestal);
  EXPECT_EQ(a.white_balance, b.white_balance);
  EXPECT_EQ(a.linear_srgb_from_camera, b.linear_srgb_from_camera);
}

TEST_F(WriteTransformsJsonTest, KeepsThatNothingIsBehind) {
  LightField written = RandomLightField(3);
  written.encoding.bayer = BayerPattern::kNone;
  written.encoding.background = {0, 0, 0};
  written.encoding.keeps_opacity = true;
  const LightField read = WrittenAndRead(written);
  EXPECT_TRUE(read.encoding.HasOpacity());
  EXPECT_EQ(read.encoding.background, written.encoding.background);
}

TEST_F(WriteTransformsJsonTest, KeepsEveryLensAndSkewWhicheverComesFirst) {
  Intrinsics plain{500, 501, 320, 240, 0, 640, 480};
  const Distortion lenses[] = {
      {},
      {DistortionModel::kRadialTangential, {0.1, 0, 0, 0, 0, 0, 0, 0}},
      {DistortionModel::kRadialTangential, {1.0 / 3, -0.2, 1e-3, -1e-4, 0, 0, 0, 0}},
      {DistortionModel::kRadialTangential, {0, 0, 0, 0, 0.3, 0, 0, 0}},
      {DistortionModel::kRadialTangential, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}},
      {DistortionModel::kRadialTangential, {0, 0, 0, 0, 0, 0, 0.7, 0}},
      {DistortionModel::kBrown, {0.1, 1.0 / 3, 1e-3, -1e-4, 0.3, -0.7}},
      {DistortionModel::kBrown, {0, 0, 0, 0, 0, 0.7}},
      {DistortionModel::kFisheye, {0.1 + 0.2, 0, -0.01, 0.007, 0, 0, 0, 0}},
      {DistortionModel::kFisheye, {}},
      {DistortionModel::kFov, {2.0 / 3, 0, 0, 0, 0, 0, 0, 0}},
      {DistortionModel::kDivision, {-1.0 / 3, 0, 0, 0, 0, 0, 0, 0}},
      {DistortionModel::kUnified, {0.1 + 0.2, 1.0 / 3, 0, 0, 0, 0, 0, 0}},
      {DistortionModel::kThinPrism, {0.1, 1.0 / 3, 1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3}},
      {DistortionModel::kRadialTangentialThinPrism,
       {0.1, 1.0 / 3, 1e-3, 2e-3, 0, 4e-3, 5e-3, 6e-3, -7e-3, 8e-3, 9e-3, 2.0 / 3}},
  };
  constexpr size_t kCount = std::size(lenses);
  for (size_t first = 0; first < kCount; ++first) {
    LightField light_field = RandomLightField(kCount);
    light_field.intrinsics.clear();
    for (size_t i = 0; i < kCount; ++i) {
      plain.distortion = lenses[(first + i) % kCount];
      plain.skew_px = i % 3 == first % 3 ? 0.1 * i : 0;
      light_field.cameras[i].intrinsics_index = i;
      light_field.intrinsics.push_back(plain);
    }
    const LightField read = WrittenAndRead(light_field);
    ASSERT_EQ(read.size(), kCount);
    for (uint32_t i = 0; i < kCount; ++i)
      EXPECT_EQ(read.Camera({i}).intrinsics, light_field.Camera({i}).intrinsics)
          << first << " " << i;
  }
}

TEST_F(WriteTransformsJsonTest, ADistortionOfZerosIsNone) {
  LightField light_field = RandomLightField(1);
  light_field.intrinsics[0].distortion.model = DistortionModel::kRadialTangential;
  EXPECT_EQ(WrittenAndRead(light_field).intrinsics[0].distortion, Distortion{});
}

TEST_F(WriteTransformsJsonTest, KeepsTheDepthRange) {
  LightField light_field = RandomLightField(1);
  EXPECT_EQ(WrittenAndRead(light_field).depth_range, std::nullopt);
  light_field.depth_range = DepthRange{1.0 / 3, 1e7};
  EXPECT_EQ(WrittenAndRead(light_field).depth_range, light_field.depth_range);
}

TEST_F(WriteTransformsJsonTest, KeepsTheSignsOfZeros) {
  LightField light_field = RandomLightField(1);
  Mat3& rotation = light_field.cameras[0].cam_from_world.rotation;
  rotation << 1, -0.0, 0.0, 0.0, 1, -0.0, -0.0, 0.0, 1;
  light_field.cameras[0].cam_from_world.translation = Vec3(0, 0, 0);
  EXPECT_TRUE(SameBits(WrittenAndRead(light_field).cameras[0], light_field.cameras[0]));
}

TEST_F(WriteTransformsJsonTest, KeepsAResponseCurveAndTheDefaults) {
  LightField light_field = RandomLightField(2);
  light_field.encoding = {};
  light_field.mask_names.clear();
  light_field.encoding.transfer = Transfer::kResponse;
  light_field.encoding.response = {-0.1, 1.0 / 3, 2};
  const LightField read = WrittenAndRead(light_field);
  EXPECT_EQ(read.encoding.response, light_field.encoding.response);
  EXPECT_EQ(read.encoding.white_level, std::nullopt);
  EXPECT_FALSE(read.encoding.masks_clipped);
  light_field.encoding.masks_clipped = true;
  EXPECT_TRUE(WrittenAndRead(light_field).encoding.masks_clipped);
  EXPECT_TRUE(read.mask_names.empty());
}

TEST_F(WriteTransformsJsonTest, FloatFilesKeepAStatedMaximum) {
  LightField light_field = RandomLightField(1);
  light_field.image_names[0] = "a.exr";
  light_field.encoding.max_radiance = 1;
  EXPECT_EQ(WrittenAndRead(light_field).encoding.max_radiance, 1);
}

TEST_F(WriteTransformsJsonTest, WhatTheFileCannotHoldIsAnErrorAndNoFile) {
  const fs::path path = folder_ / "transforms.json";
  const auto expect = [&](const LightField& light_field, const std::string& part) {
    const Result<void> written = WriteTransformsJson(light_field, path);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().kind, ErrorKind::kOutput);
    EXPECT_NE(written.error().message.find(path.string()), std::string::npos);
    EXPECT_NE(written.error().message.find(part), std::string::npos) << written.error().message;
    EXPECT_FALSE(fs::exists(path));
  };
  LightField unnamed = RandomLightField(3);
  unnamed.image_names[2] = "r_2";
  expect(unnamed, "\"r_2\" has no extension");
  LightField latin1 = RandomLightField(3);
  latin1.image_names[1] = "\xe9.png";
  expect(latin1, "not UTF-8");
}

TEST_F(WriteTransformsJsonTest, AnImpossiblePlaceIsAnOutputError) {
  const Result<void> written =
      WriteTransformsJson(RandomLightField(1), folder_ / "none" / "t.json");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kOutput);
}

TEST_F(WriteTransformsJsonTest, KnowsWhatItWroteUntilSomebodyChangesIt) {
  LightField light_field;
  light_field.intrinsics = {{70, 70, 32, 24, 0, 64, 48}};
  light_field.cameras.resize(2);
  light_field.image_names = {"a.png", "b.png"};
  const fs::path path = folder_ / "transforms.json";
  ASSERT_TRUE(WriteTransformsJson(light_field, path));
  EXPECT_FALSE(*IsAsWritten(path, "lfimport"));
  ASSERT_TRUE(WriteTransformsJson(light_field, path, "lfimport"));
  EXPECT_TRUE(*IsAsWritten(path, "lfimport"));
  EXPECT_FALSE(*IsAsWritten(path, "lfexport"));
  const Result<LightField> read = ReadTransformsJson(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->image_names, light_field.image_names);

  std::string text = *ReadFile(path);
  text.replace(text.find("b.png"), 5, "c.png");
  ASSERT_TRUE(WriteFileAtomically(path, text));
  EXPECT_FALSE(*IsAsWritten(path, "lfimport"));
  ASSERT_TRUE(WriteFileAtomically(path, "{"));
  EXPECT_FALSE(*IsAsWritten(path, "lfimport"));
  EXPECT_FALSE(IsAsWritten(folder_ / "none", "lfimport"));
}

}  // namespace
}  // namespace lf
