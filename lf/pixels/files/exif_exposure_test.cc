// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/exif_exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_dng.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

// One tag of Exif data: a fraction, or a number of 16 or 32 bits.
struct Tag {
  int tag;
  int type;  // 3: 16 bits, 4: 32 bits, 5: a fraction, 10: a signed fraction
  int value;
  int under = 1;
};

void Append(uint64_t value, int bytes, std::string* text) {
  for (int i = 0; i < bytes; ++i) *text += static_cast<char>(value >> 8 * i & 255);
}

// Returns a little-endian TIFF file whose first directory names an Exif directory with these tags.
std::string ExifOf(const std::vector<Tag>& tags) {
  std::string file("II*\0\x08\0\0\0\x01\0\x69\x87\x04\0\x01\0\0\0\x1a\0\0\0\0\0\0\0", 26), values;
  Append(tags.size(), 2, &file);
  const size_t values_begin = file.size() + 12 * tags.size() + 4;
  for (const Tag& tag : tags) {
    Append(static_cast<uint64_t>(tag.tag), 2, &file);
    Append(static_cast<uint64_t>(tag.type), 2, &file);
    Append(1, 4, &file);
    const bool is_fraction = tag.type == 5 || tag.type == 10;
    Append(is_fraction ? values_begin + values.size() : static_cast<uint64_t>(tag.value), 4, &file);
    if (!is_fraction) continue;
    Append(static_cast<uint64_t>(tag.value), 4, &values);
    Append(static_cast<uint64_t>(tag.under), 4, &values);
  }
  return file + std::string(4, '\0') + values;
}

ExposureFacts FactsOf(const std::string& file, ImageFormat format) {
  return ExposureOfExif(
      [&file](uint64_t offset, std::span<uint8_t> to) -> size_t {
        if (offset >= file.size()) return 0;
        return file.copy(reinterpret_cast<char*>(to.data()), to.size(), offset);
      },
      format);
}

ExposureFacts FactsOfTags(const std::vector<Tag>& tags) {
  return FactsOf(ExifOf(tags), ImageFormat::kTiff);
}

const std::vector<Tag> kAll = {{0x829A, 5, 1, 125}, {0x829D, 5, 28, 10}, {0x8827, 3, 400}};

void ExpectAll(const ExposureFacts& facts) {
  EXPECT_EQ(facts.time_s, 1. / 125);
  EXPECT_EQ(facts.f_number, 2.8);
  EXPECT_EQ(facts.iso, 400);
}

TEST(ExifExposure, IsThatOfTheThreeFormats) {
  const std::string exif = ExifOf(kAll);
  ExpectAll(FactsOf(exif, ImageFormat::kTiff));
  std::string jpeg = "\xff\xd8";
  jpeg += std::string("\xff\xe0\0\x04zz", 6) + "\xff\xff\xe1";  // another segment, and a fill byte
  jpeg += {0, static_cast<char>(exif.size() + 8)};
  jpeg += std::string("Exif\0\0", 6) + exif + "\xff\xda";
  ExpectAll(FactsOf(jpeg, ImageFormat::kJpeg));
  std::string png = "\x89PNG\r\n\x1a\n" + std::string("\0\0\0\x02tEXtab....", 14);
  png += {0, 0, 0, static_cast<char>(exif.size())};
  ExpectAll(FactsOf(png + "eXIf" + exif + "....", ImageFormat::kPng));
}

TEST(ExifExposure, IsMissingWhereTheFileDoesNotTell) {
  for (const ImageFormat format :
       {ImageFormat::kTiff, ImageFormat::kJpeg, ImageFormat::kPng, ImageFormat::kExr}) {
    const ExposureFacts facts = FactsOf("II*\0\x08\0\0\0, and no directory", format);
    EXPECT_FALSE(facts.time_s || facts.f_number || facts.iso);
  }
  const std::string exif = ExifOf(kAll);
  const ExposureFacts cut = FactsOf(exif.substr(0, exif.size() - 16), ImageFormat::kTiff);
  EXPECT_FALSE(cut.time_s || cut.f_number);
  EXPECT_EQ(cut.iso, 400);
}

TEST(ExifExposure, ZeroIsNotKnown) {
  const ExposureFacts facts = FactsOfTags({{0x829A, 5, 0, 1}, {0x829D, 5, 0, 0}, {0x8827, 3, 0}});
  EXPECT_FALSE(facts.time_s || facts.f_number || facts.iso);
}

TEST(ExifExposure, ApexValuesStandInForMissingOnes) {
  const ExposureFacts facts = FactsOfTags({{0x9201, 10, 7, 1}, {0x9202, 5, 3, 1}});
  EXPECT_DOUBLE_EQ(*facts.time_s, 1. / 128);
  EXPECT_DOUBLE_EQ(*facts.f_number, std::sqrt(8.));
  std::vector<Tag> both = kAll;
  both.insert(both.end(), {{0x9201, 10, 1, 1}, {0x9202, 5, 1, 1}});
  ExpectAll(FactsOfTags(both));
}

TEST(ExifExposure, ASensitivityBeyond16BitsHasATagOfItsOwn) {
  EXPECT_EQ(FactsOfTags({{0x8827, 3, 65535}, {0x8832, 4, 102400}}).iso, 102400);
  EXPECT_EQ(FactsOfTags({{0x8827, 3, 65535}, {0x8833, 4, 204800}}).iso, 204800);
  EXPECT_EQ(FactsOfTags({{0x8827, 3, 200}, {0x8833, 4, 204800}}).iso, 200);
}

class ExposureOfFile : public FolderTest {};

TEST_F(ExposureOfFile, IsReadFromAFileWithPixels) {
  ASSERT_TRUE(WriteImage(folder_ / "a.png", NoiseImage<uint8_t>(16, 16, 3).view()));
  const ExposureFacts none = ReadExposureFacts(folder_ / "a.png").value();
  EXPECT_FALSE(none.time_s || none.f_number || none.iso);
  std::ifstream in(folder_ / "a.png", std::ios::binary);
  std::string png((std::istreambuf_iterator<char>(in)), {});
  const std::string exif = ExifOf(kAll);
  const std::string length = {0, 0, 0, static_cast<char>(exif.size())};
  png.insert(33, length + "eXIf" + exif + "....");  // behind the chunk of the header
  ExpectAll(ReadExposureFactsBytes(png, "a.png").value());
}

TEST_F(ExposureOfFile, IsThatOfACameraRawFile) {
  Image<uint16_t> mosaic(32, 24, 1);
  TestDng dng(mosaic, "RGGB");
  dng.Fractions(0x829A, 5, {{1, 125}}).Fractions(0x829D, 5, {{28, 10}});
  const ExposureFacts facts = ReadExposureFactsBytes(dng.File(), "a.dng").value();
  EXPECT_NEAR(facts.time_s.value_or(0), 1. / 125, 1e-8);
  EXPECT_NEAR(facts.f_number.value_or(0), 2.8, 1e-6);
  EXPECT_FALSE(facts.iso);  // LibRaw takes it from an Exif directory, which this file lacks
}

TEST_F(ExposureOfFile, AFileThatIsNoneIsNamed) {
  EXPECT_NE(ReadExposureFacts(folder_ / "b.jpg").error().message.find("b.jpg"), std::string::npos);
  EXPECT_NE(ReadExposureFactsBytes("text", "c.jpg").error().message.find("c.jpg"),
            std::string::npos);
}

}  // namespace
}  // namespace lf
