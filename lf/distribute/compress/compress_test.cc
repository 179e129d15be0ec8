// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/compress.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/distribute/compress/code_quality.h"

namespace lf {
namespace {

TEST(CodeQuality, AGreyStepIsAPartOfWhatLiesBetweenTheLevels) {
  RadianceEncoding encoding;
  EXPECT_EQ(GreyStep(encoding, StoredValues::kUint8), 1);
  EXPECT_EQ(GreyStep(encoding, StoredValues::kUint16), 257);
  EXPECT_EQ(GreyStep(encoding, StoredValues::kHalf), 16);
  encoding.black_level = 255;
  encoding.white_level = 4080;
  EXPECT_EQ(GreyStep(encoding, StoredValues::kUint16), 15);
}

TEST(CodeQuality, PsnrIsOfAllValuesTogether) {
  Image<uint8_t> a(10, 10), b(10, 10);
  b.at(3, 4) = 10;
  DecodedPart part{b, {0, 0, 10, 10}};
  CodeError error = ErrorOf(a, part, 1);
  EXPECT_NEAR(error.PsnrDb(), 10 * std::log10(255.0 * 255 * 100 / 100), 1e-9);
  error += ErrorOf(a, DecodedPart{a, {0, 0, 10, 10}}, 1);
  EXPECT_NEAR(error.PsnrDb(), 10 * std::log10(255.0 * 255 * 200 / 100), 1e-9);
  EXPECT_TRUE(std::isinf(CodeError{}.PsnrDb()));
}

// Returns a package of these LF images, all of which have the second intrinsics of the light field.
Package PackageOf(const std::string& name, std::vector<PackageImage> images) {
  Package package;
  package.name = name;
  package.whole = {9, "names", "calibration"};
  Intrinsics intrinsics;
  intrinsics.width_px = 100;
  intrinsics.height_px = 80;
  package.light_field.intrinsics = {Intrinsics{}, intrinsics};
  for (const PackageImage& image : images) {
    LfCamera camera;
    camera.intrinsics_index = 1;
    camera.cam_from_world.translation = Vec3(image.id, 0, 0);
    package.light_field.cameras.push_back(camera);
    package.light_field.image_names.push_back("image " + std::to_string(image.id));
  }
  package.images = std::move(images);
  return package;
}

TEST(CompressSource, PackagesAreJoined) {
  const Package packages[] = {
      PackageOf("a", {{7, 1, {10, 10, 20, 20}, 1, 100}, {2, 1, {0, 0, 5, 5}, 1, 25}}),
      PackageOf("b", {{7, 1, {15, 5, 30, 12}, 1, 100}, {4, 1, {}, 0, 0}})};
  const Result<CompressSource> part = SourceOfPackages(packages, true);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->whole_ids, (std::vector<uint32_t>{2, 7}));
  EXPECT_EQ(part->rects, (std::vector<PixelRect>{{0, 0, 5, 5}, {10, 5, 30, 20}}));
  EXPECT_EQ(part->light_field.image_names, (std::vector<std::string>{"image 2", "image 7"}));
  EXPECT_EQ(part->light_field.intrinsics.size(), 1u);
  EXPECT_EQ(part->light_field.cameras[1].cam_from_world.translation.x(), 7);
  EXPECT_EQ(part->whole, packages[0].whole);
  const Result<CompressSource> whole = SourceOfPackages(packages, false);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->rects[0], (PixelRect{0, 0, 100, 80}));
}

TEST(CompressSource, PackagesOfDifferentLightFieldsAreAUsageError) {
  Package packages[] = {PackageOf("a", {{7, 1, {10, 10, 20, 20}, 1, 100}}),
                        PackageOf("b", {{7, 1, {10, 10, 20, 20}, 1, 100}})};
  packages[1].whole.calibration = "another";
  const Result<CompressSource> source = SourceOfPackages(packages, false);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().kind, ErrorKind::kUsage);
  packages[0].images[0].ray_count = 0;
  EXPECT_FALSE(SourceOfPackages(std::span(packages, 1), false));
}

TEST(CompressOptions, SettingsAreNamed) {
  EXPECT_EQ(NameOf(CodecSettings{}), "default, levels 4, threshold 3");
  EXPECT_EQ(NameOf(CodecSettings{CodecProfile::kThesis, 1, 8, 256}),
            "thesis, levels 1, threshold 8, quantizer 256");
  EXPECT_EQ(NameOf(CodecSettings{CodecProfile::kLossless, 2, 0, 0}), "lossless, levels 2");
}

}  // namespace
}  // namespace lf
