// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/compress.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/distribute/compress/code_quality.h"
#include "lf/distribute/compress/image_coder.h"

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

TEST(CodeQuality, ErrorsOfPartsAddUp) {
  Image<uint8_t> a(7, 5, 3, 100), b = a;
  b.at(6, 2, 1) = 90;
  b.at(0, 4, 2) = 103;
  CodeError parts;
  for (const PixelRect& rect : {PixelRect{0, 0, 7, 3}, PixelRect{0, 3, 4, 5}, {4, 3, 7, 5}}) {
    Image<uint8_t> part(rect.width(), rect.height(), 3);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x)
        for (int c = 0; c < 3; ++c) part.at(x, y, c) = b.at(rect.x_begin + x, rect.y_begin + y, c);
    parts += ErrorOf(a, DecodedPart{part, rect}, 1);
  }
  const CodeError whole = ErrorOf(a, DecodedPart{b, {0, 0, 7, 5}}, 1);
  EXPECT_EQ(parts.count, whole.count);
  EXPECT_NEAR(parts.squared, whole.squared, 1e-15);
  EXPECT_NEAR(whole.squared, 109.0 / (255 * 255), 1e-15);
}

// Returns an LF image that is higher than two tiles.
RecordedImage TallImage() {
  Image<uint16_t> pixels(9, 2100);
  uint32_t state = 1;
  for (uint16_t& value : pixels.pixels()) {
    state = state * 1664525 + 1013904223;
    value = static_cast<uint16_t>(20000 + (state >> 20));
  }
  RecordedImage image;
  image.pixels = std::move(pixels);
  image.values = StoredValues::kUint16;
  image.rect = {0, 0, 9, 2100};
  return image;
}

TEST(ImageCoder, TheErrorIsThatOfTheWholeImage) {
  const RecordedImage image = TallImage();
  const ImageCoder coder(RadianceEncoding(), CodecSettings(), KeepFiles::kNone, {});
  const Result<CodedImage> coded = coder.Code(image);
  ASSERT_TRUE(coded);
  DecodedPart decoded;
  ASSERT_TRUE(DecodeImage(coded->code, &decoded));
  const CodeError whole =
      ErrorOf(image.pixels, decoded, GreyStep(RadianceEncoding(), StoredValues::kUint16));
  const Result<CodeError> error = coder.ErrorOf(image, *coded);
  ASSERT_TRUE(error);
  EXPECT_GT(whole.squared, 0);
  EXPECT_EQ(error->count, whole.count);
  EXPECT_NEAR(error->squared / whole.squared, 1, 1e-12);
}

TEST(ImageCoder, EncodingAndMeasuringEndIfInterrupted) {
  RecordedImage image = TallImage();
  bool is_interrupted = false;
  const ImageCoder coder(RadianceEncoding(), CodecSettings(), KeepFiles::kNone,
                         [&] { return is_interrupted; });
  const Result<CodedImage> coded = coder.Code(image);
  ASSERT_TRUE(coded);
  is_interrupted = true;
  const Result<CodedImage> again = coder.Code(image);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kInterrupted);
  const Result<CodeError> error = coder.ErrorOf(image, *coded);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().kind, ErrorKind::kInterrupted);
}

// Returns a light field of 9 LF images that have no files.
LightField Field() {
  LightField field;
  field.folder = "/nowhere";
  Intrinsics intrinsics;
  intrinsics.width_px = 100;
  intrinsics.height_px = 80;
  field.intrinsics = {intrinsics};
  for (uint32_t i = 0; i < 9; ++i) {
    LfCamera camera;
    camera.cam_from_world.translation = Vec3(i, 0, 0);
    field.cameras.push_back(camera);
    field.image_names.push_back("image " + std::to_string(i));
  }
  return field;
}

// Returns a package of these LF images of Field().
Package PackageOf(const std::string& name, std::vector<PackageImage> images) {
  Package package;
  package.name = name;
  const LightField field = Field();
  package.whole = IdentityOf(field);
  package.light_field.intrinsics = field.intrinsics;
  package.light_field.encoding.pedestal = 7;
  for (const PackageImage& image : images) {
    package.light_field.cameras.push_back(field.cameras[image.id]);
    package.light_field.image_names.push_back(field.image_names[image.id]);
  }
  package.images = std::move(images);
  return package;
}

TEST(CompressSource, PackagesAreJoinedAndAllLfCamerasStay) {
  const Package packages[] = {
      PackageOf("a", {{7, 1, {10, 10, 20, 20}, 1, 100}, {2, 1, {0, 0, 5, 5}, 1, 25}}),
      PackageOf("b", {{7, 1, {15, 5, 30, 12}, 1, 100}, {4, 1, {}, 0, 0}})};
  const Result<CompressSource> part = SourceOfPackages(Field(), packages, true);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->CompressedIds(), (std::vector<LfImageId>{{2}, {7}}));
  EXPECT_EQ(part->rects[2], (PixelRect{0, 0, 5, 5}));
  EXPECT_EQ(part->rects[7], (PixelRect{10, 5, 30, 20}));
  EXPECT_TRUE(part->rects[4].empty());
  EXPECT_EQ(IdentityOf(part->light_field), IdentityOf(Field()));
  EXPECT_EQ(part->whole, packages[0].whole);
  EXPECT_EQ(part->light_field.encoding.pedestal, 7);
  // The footprint is stated, because it could not be measured where LF images are left out.
  EXPECT_TRUE(part->light_field.encoding.footprint);
  const Result<CompressSource> whole = SourceOfPackages(Field(), packages, false);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->rects[2], (PixelRect{0, 0, 100, 80}));
  EXPECT_TRUE(whole->rects[4].empty());
}

TEST(CompressSource, OtherLightFieldsAndPackagesWithoutRaysAreErrors) {
  Package packages[] = {PackageOf("a", {{7, 1, {10, 10, 20, 20}, 1, 100}}),
                        PackageOf("b", {{7, 1, {10, 10, 20, 20}, 1, 100}})};
  LightField moved = Field();
  moved.cameras[1].cam_from_world.translation.y() += 1;
  const Result<CompressSource> of_another = SourceOfPackages(moved, packages, false);
  ASSERT_FALSE(of_another);
  EXPECT_EQ(of_another.error().kind, ErrorKind::kInput);
  EXPECT_NE(of_another.error().message.find("{lightfield}"), std::string::npos);
  packages[1].whole.calibration = "another";
  const Result<CompressSource> source = SourceOfPackages(Field(), packages, false);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().kind, ErrorKind::kUsage);
  packages[0].images[0].id = 9;
  const Result<CompressSource> beyond = SourceOfPackages(Field(), std::span(packages, 1), false);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().kind, ErrorKind::kInput);
  packages[0].images[0].ray_count = 0;
  EXPECT_FALSE(SourceOfPackages(Field(), std::span(packages, 1), false));
}

TEST(CompressOptions, SettingsAreNamed) {
  EXPECT_EQ(NameOf(Encoding{}), "default, levels 4, threshold 3");
  EXPECT_EQ(NameOf(Encoding{{}, KeepFiles::kSmaller}),
            "default, levels 4, threshold 3, or the image file if it is smaller");
  EXPECT_EQ(NameOf(Encoding{{CodecProfile::kThesis, 1, 8, 256}}),
            "thesis, levels 1, threshold 8, quantizer 256");
  EXPECT_EQ(NameOf(Encoding{{}, KeepFiles::kNone, true}),
            "default, levels 4, threshold 3, in groups");
  EXPECT_EQ(NameOf(Encoding{{CodecProfile::kLossless, 2, 0, 0}, KeepFiles::kAll}),
            "lossless, levels 2, or the image file");
}

}  // namespace
}  // namespace lf
