// SPDX-License-Identifier: Apache-2.0
// Files whose pixels lie there as they are: Netpbm, PFM, BMP and Radiance. python/tests/
// test_image_files.py compares whole pictures with those of other programs.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {
using namespace std::string_literals;

std::string MessageOf(const std::string& bytes) {
  const Result<StoredImage> read = ReadImageBytes(bytes, "a");
  return read ? "accepted" : read.error().message;
}

// Reads columns 1 and 2 of row 1 of a picture of at least 4 x 2 pixels.
ImagePart PartOf(const std::string& bytes) {
  ImagePart part;
  const auto wanted = [](const ImageFileInfo&) -> Result<PixelRect> {
    return PixelRect{1, 1, 3, 2};
  };
  const Result<void> read = ReadImagePartBytes(bytes, "a", wanted, &part);
  EXPECT_TRUE(read) << read.error().message;
  return part;
}

// The head of a BMP file of 4 x 2 pixels of 24 bits.
std::string BmpHead(int height) {
  return "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\4\0\0\0"s + static_cast<char>(height) +
         (height < 0 ? "\xff\xff\xff"s : "\0\0\0"s) + "\1\0\x18\0"s + std::string(24, '\0');
}

TEST(SimpleFiles, APartOfThePixelsIsReadAlone) {
  const ImagePart grey = PartOf("P5 4 2 255\n01234567"s);
  EXPECT_EQ(grey.rect, (PixelRect{1, 1, 3, 2}));
  EXPECT_EQ(std::get<Image<uint8_t>>(grey.image).pixels(), (LargeVector<uint8_t>{'5', '6'}));
  // 10101010 and 01100000: 1 is black.
  const ImagePart bits = PartOf("P4 4 2\n\xaa\x60"s);
  EXPECT_EQ(std::get<Image<uint8_t>>(bits.image).pixels(), (LargeVector<uint8_t>{0, 0}));
  // BMP files begin with the lowest row, with blue.
  const ImagePart bmp = PartOf(BmpHead(2) + "bgrBGRcdeCDE............");
  EXPECT_EQ(bmp.rect, (PixelRect{1, 1, 3, 2}));
  EXPECT_EQ(std::get<Image<uint8_t>>(bmp.image).pixels(),
            (LargeVector<uint8_t>{'R', 'G', 'B', 'e', 'd', 'c'}));
  const ImagePart top_down = PartOf(BmpHead(-2) + "............bgrBGRcdeCDE");
  EXPECT_EQ(std::get<Image<uint8_t>>(top_down.image).pixels(),
            (LargeVector<uint8_t>{'R', 'G', 'B', 'e', 'd', 'c'}));
}

TEST(SimpleFiles, PfmIsReadFromBelowInBothOrdersOfBytes) {
  const std::string little = "Pf\n1 2\n-1\n\0\0\0\x40\0\0\x80\x3f"s;
  EXPECT_EQ(std::get<Image<float>>(*ReadImageBytes(little, "a")).pixels(),
            (LargeVector<float>{1, 2}));
  const std::string big = "Pf 1 1 1\n\x3f\xc0\0\0"s;
  EXPECT_EQ(std::get<Image<float>>(*ReadImageBytes(big, "a")).pixels(), (LargeVector<float>{1.5F}));
  EXPECT_NE(MessageOf("Pf\n1 2\n-1\n\0\0\0\x40\0\0\0"s).find("truncated"), std::string::npos);
  EXPECT_NE(MessageOf("Pf\n1 2\n0\n\0\0\0\x40"s).find("scale other than 0"), std::string::npos);
}

TEST(SimpleFiles, RunsOfOldRadianceFilesRepeatAPixel) {
  // 3 x 1 pixels: one, and a run that repeats it twice. 128 is the exponent of 1/256.
  const auto read = ReadImageBytes(
      "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 3\n"s + "\x10\x20\x40\x88\1\1\1\2"s, "a");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(std::get<Image<float>>(*read).pixels(),
            (LargeVector<float>{16, 32, 64, 16, 32, 64, 16, 32, 64}));
}

TEST(SimpleFiles, RadianceFilesMayBeginBelowOrAtTheRight) {
  const std::string head = "#?RADIANCE\n\n+Y 2 -X 1\n";
  const auto read = ReadImageBytes(head + "\1\0\0\x88\2\0\0\x88"s, "a");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(std::get<Image<float>>(*read).at(0, 0, 0), 2);
  EXPECT_EQ(std::get<Image<float>>(*read).at(0, 1, 0), 1);
}

TEST(SimpleFiles, DamageIsNamed) {
  const std::pair<std::string, std::string> cases[] = {
      {"P5 4 2 255\n0123456"s, "truncated"},
      {"P5 4 2 0\n01234567"s, "value of white from 1 to 65535"},
      {"P5 4 x 255\n01234567"s, "is damaged"},
      {"P5 4 2 49\n01234567"s, "has the value 55, but states that 49 is white"},
      {"P2 2 1 255\n7 "s, "expected 2 numbers"},
      {"P1 2 1\n12"s, "0 or 1"},
      {"P5 99999 99999 255\n0"s, "more than the limit"},
      {BmpHead(2) + "bgr", "truncated"},
      {"BM\0\0\0\0\0\0\0\0\x36\0\0\0\x29"s, "damaged or truncated head"},
      {"#?RADIANCE\n\n-Y 2 +X 1\n\1\0\0\x88"s, "row 2 of 2"},
      {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 1\n"s, "another kind than RGB"},
      {"#?RADIANCE\n\n+X 2 +Y 1\n\1\0\0\x88"s, "expected an empty line"},
  };
  for (const auto& [bytes, said] : cases)
    EXPECT_NE(MessageOf(bytes).find(said), std::string::npos) << said << ": " << MessageOf(bytes);
}

TEST(SimpleFiles, PalettesThatAreTooShortAreAnError) {
  // 1 x 1 pixel of 8 bits, which is colour 3 of a palette of 2 colours.
  const std::string head = "BM\0\0\0\0\0\0\0\0\x3e\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x08\0"s +
                           std::string(16, '\0') + "\2\0\0\0\0\0\0\0"s + "bgr\0BGR\0"s;
  EXPECT_NE(MessageOf(head + "\3..."s).find("colour 3 of a palette of 2"), std::string::npos);
  EXPECT_EQ(std::get<Image<uint8_t>>(*ReadImageBytes(head + "\1..."s, "a")).pixels(),
            (LargeVector<uint8_t>{'R', 'G', 'B'}));
}

}  // namespace
}  // namespace lf
