#include <cmath>

#include "lf/core/file.h"
#include "lf/imageio/image_file.h"
#include "lf/imageio/test_dng.h"
#include "lf/imageio/test_folder.h"

namespace lf {
namespace {

constexpr const char* kPatterns[] = {"RGGB", "BGGR", "GRBG", "GBRG"};

Image<uint16_t> Mosaic(int width = 40, int height = 30) {
  return NoiseImage<uint16_t>(width, height, 1);
}

ImageWithInfo Read(const TestDng& dng) {
  Result<ImageWithInfo> read = ReadImageWithInfoBytes(dng.File(), "a.dng");
  EXPECT_TRUE(read) << read.error().message;
  return read ? *std::move(read)
              : ImageWithInfo{Image<uint16_t>(), {0, 0, 0, 0, false, {}, 1, RawFacts{}}};
}

LargeVector<uint16_t> PixelsOf(const ImageWithInfo& read) {
  return std::get<Image<uint16_t>>(read.image).pixels();
}

std::string ErrorOf(const std::string& bytes) {
  const Result<ImageWithInfo> read = ReadImageWithInfoBytes(bytes, "a.dng");
  EXPECT_FALSE(read);
  if (read) return "";
  EXPECT_EQ(read.error().kind, ErrorKind::kInput);
  EXPECT_TRUE(read.error().message.starts_with("a.dng: ")) << read.error().message;
  EXPECT_EQ(read.error().message.find("/proc"), std::string::npos) << read.error().message;
  return read.error().message;
}

void ExpectFault(const TestDng& dng, const std::string& reason) {
  const std::string message = ErrorOf(dng.File());
  EXPECT_NE(message.find(reason), std::string::npos) << message;
}

TEST(RawImage, StoredValuesComeBitForBitInAllPatternsAndSizes) {
  for (const char* pattern : kPatterns)
    for (const auto& [width, height] :
         {std::pair(40, 30), {41, 30}, {40, 31}, {41, 31}, {22, 22}}) {
      const Image<uint16_t> mosaic = Mosaic(width, height);
      const ImageWithInfo read = Read(TestDng(mosaic, pattern).Long(50714, {512}));
      EXPECT_EQ(PixelsOf(read), mosaic.pixels()) << pattern << " " << width << " x " << height;
      EXPECT_EQ(std::tuple(read.info.width, read.info.height, read.info.channels, read.info.bits),
                std::tuple(width, height, 1, 16));
    }
}

TEST(RawImage, NothingButTheMosaicDecidesItsValues) {
  const Image<uint16_t> mosaic = Mosaic();
  for (uint32_t orientation = 1; orientation <= 8; ++orientation) {
    TestDng dng(mosaic, "GRBG");
    dng.Short(274, {orientation}).Long(50714, {1000}).Long(50717, {9000});
    dng.Fractions(50728, 5, {{1, 4}, {1, 1}, {1, 3}});
    dng.Fractions(50721, 10,
                  {{2, 1}, {-1, 2}, {0, 1}, {-1, 3}, {1, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 1}});
    dng.Long(50719, {4, 2}).Long(50720, {30, 20});  // default crop: for developed pictures
    dng.Fractions(50730, 10, {{2, 1}});             // baseline exposure
    EXPECT_EQ(PixelsOf(Read(dng)), mosaic.pixels()) << orientation;
  }
}

TEST(RawImage, TheTagsTellThePattern) {
  const BayerPattern expected[] = {BayerPattern::kRggb, BayerPattern::kBggr, BayerPattern::kGrbg,
                                   BayerPattern::kGbrg};
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(Read(TestDng(Mosaic(), kPatterns[i])).info.raw.value().bayer, expected[i]);
  for (const char* implausible : {"RGBG", "RRGB", "GGRB", "RGBB", "GGGG"})
    EXPECT_EQ(Read(TestDng(Mosaic(), implausible)).info.raw.value().bayer, BayerPattern::kNone)
        << implausible;
  TestDng other_colours(Mosaic(), "RGGB");
  EXPECT_EQ(Read(other_colours.Bytes(50710, "\3\4\5")).info.raw.value().bayer, BayerPattern::kNone);
}

TEST(RawImage, TheActiveAreaIsTheImage) {
  const Image<uint16_t> mosaic = Mosaic(60, 50);
  TestDng dng(mosaic, "BGGR");
  dng.Long(50829, {2, 4, 46, 57});  // top, left, bottom, right
  const ImageWithInfo read = Read(dng);
  ASSERT_EQ(read.info.width, 53);
  ASSERT_EQ(read.info.height, 44);
  for (int y = 0; y < 44; ++y)
    for (int x = 0; x < 53; ++x)
      ASSERT_EQ(std::get<Image<uint16_t>>(read.image).at(x, y), mosaic.at(x + 4, y + 2));
  EXPECT_EQ(read.info.raw->bayer, BayerPattern::kBggr);
}

TEST(RawImage, LevelsAreThoseOfTheTags) {
  const RawFacts plain = *Read(TestDng(Mosaic(), "RGGB")).info.raw;
  EXPECT_EQ(plain.black_level, 0);
  EXPECT_EQ(plain.white_level, 65535);
  TestDng dng(Mosaic(), "RGGB");
  dng.Short(50713, {2, 2}).Fractions(50714, 5, {{512, 1}, {1025, 2}, {1025, 2}, {513, 1}});
  const RawFacts facts = *Read(dng.Short(50717, {16383})).info.raw;
  EXPECT_EQ(facts.black_level, 512.5);
  EXPECT_EQ(facts.white_level, 16383);
  EXPECT_FALSE(Read(dng.Long(50714, {70000})).info.raw->black_level);
}

// Camera RGB = ColorMatrix1 XYZ; its rows balanced so that white gives 1, 1, 1 (DNG 1.4, chapter
// 6).
TEST(RawImage, ColoursAreThoseOfTheTags) {
  TestDng dng(Mosaic(), "RGGB");
  const RawFacts unknown = *Read(dng).info.raw;
  EXPECT_FALSE(unknown.white_balance);
  EXPECT_FALSE(unknown.camera_to_srgb);
  dng.Fractions(50728, 5, {{1, 2}, {1, 1}, {4, 5}}).Short(50778, {21});
  dng.Fractions(50721, 10,
                {{1, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 1}});
  const RawFacts facts = *Read(dng).info.raw;
  ASSERT_TRUE(facts.white_balance && facts.camera_to_srgb);
  EXPECT_NEAR((*facts.white_balance)[0], 2, 1e-6);
  EXPECT_EQ((*facts.white_balance)[1], 1);
  EXPECT_NEAR((*facts.white_balance)[2], 1.25, 1e-6);
  Mat3 xyz_from_srgb;  // IEC 61966-2-1
  xyz_from_srgb << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Vec3 white = xyz_from_srgb * Vec3::Ones();
  const Mat3 camera_from_srgb = white.cwiseInverse().asDiagonal() * xyz_from_srgb;
  EXPECT_LT((*facts.camera_to_srgb * camera_from_srgb - Mat3::Identity()).cwiseAbs().maxCoeff(),
            2e-3);
}

TEST(RawImage, WhatIsNoBayerMosaicIsRefused) {
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(33421, {6, 6}), "X-Trans");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(262, {34892}), "linear DNG");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(262, {2}), "does not state its mosaic");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(50711, {2}), "staggered");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(339, {3}), "floating point");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(277, {3}), "3 channels");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(258, {32}), "32 bits");
  ExpectFault(TestDng(Mosaic(21, 21), "RGGB"), "22 pixels");
}

TEST(RawImage, AFileCutAnywhereIsAnError) {
  const std::string whole = TestDng(Mosaic(), "RGGB").File();
  for (size_t size = 0; size < whole.size(); size += size < 600 ? 1 : 97)
    ErrorOf(whole.substr(0, size));
  ErrorOf(whole.substr(0, whole.size() - 1));
}

TEST(RawImage, ClaimsAreCheckedBeforeLibRawBelievesThem) {
  ExpectFault(TestDng(Mosaic(), "RGGB").Long(256, {65536}).Long(257, {65536}), "more than the");
  ExpectFault(TestDng(Mosaic(), "RGGB").Long(257, {31}), "too short");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(259, {7}).Long(257, {65536}), "too short");
  ExpectFault(TestDng(Mosaic(), "RGGB").Long(279, {1u << 30}), "ends before its pixels");
  ExpectFault(TestDng(Mosaic(), "RGGB").Without(273), "where its pixels are");
  ExpectFault(TestDng(Mosaic(), "RGGB").Long(256, {0}), "claims 0 x 30");
  ExpectFault(TestDng(Mosaic(), "RGGB").Long(50829, {0, 0, 31, 40}), "active area");
}

class RawFileTest : public FolderTest {};

TEST_F(RawFileTest, TheHeaderAndThePixelsAreReadFromDiskUnderAnyName) {
  const Image<uint16_t> mosaic = Mosaic();
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.tif", TestDng(mosaic, "GBRG").File()));
  const Result<ImageFileInfo> info = ReadImageInfo(folder_ / "a.tif");
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->raw.value().bayer, BayerPattern::kGbrg);
  EXPECT_EQ(std::get<Image<uint16_t>>(ReadImage(folder_ / "a.tif").value()).pixels(),
            mosaic.pixels());
}

}  // namespace
}  // namespace lf
