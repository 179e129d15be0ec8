// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_dng.h"
#include "lf/pixels/files/test_folder.h"

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

LargeVector<uint16_t> RawPixelsOf(const ImageWithInfo& read) {
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
      EXPECT_EQ(RawPixelsOf(read), mosaic.pixels()) << pattern << " " << width << " x " << height;
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
    dng.Long(50719, {4, 2}).Long(50720, {30, 20});  // default crop, for developed pictures only
    dng.Fractions(50730, 10, {{2, 1}});             // baseline exposure
    EXPECT_EQ(RawPixelsOf(Read(dng)), mosaic.pixels()) << orientation;
  }
}

TEST(RawImage, PackedAndCompressedValuesComeBitForBit) {
  for (const auto& [width, height] : {std::pair(40, 30), {41, 31}, {75, 50}}) {
    const Image<uint16_t> noise = Mosaic(width, height);
    for (const int bits : {10, 12, 14}) {
      Image<uint16_t> mosaic = noise;
      for (uint16_t& value : mosaic.pixels()) value >>= 16 - bits;
      EXPECT_EQ(RawPixelsOf(Read(TestDng(mosaic, "GRBG").Packed(bits))), mosaic.pixels())
          << width << " x " << height << ", " << bits << " bits";
    }
    for (const int tile : {16, 32})
      EXPECT_EQ(RawPixelsOf(Read(TestDng(noise, "GBRG").Tiled(tile, tile / 2, true))),
                noise.pixels())
          << width << " x " << height << ", tiles of " << tile;
  }
  const Image<uint16_t> noise = Mosaic(40, 30);
  EXPECT_EQ(RawPixelsOf(Read(TestDng(noise, "GBRG").Tiled(40, 30, true))), noise.pixels());
}

TEST(RawImage, ALinearizationTableIsApplied) {
  Image<uint16_t> mosaic = Mosaic();
  for (uint16_t& value : mosaic.pixels()) value %= 256;
  std::vector<uint32_t> squares;
  for (uint32_t i = 0; i < 256; ++i) squares.push_back(i * i);
  const ImageWithInfo read = Read(TestDng(mosaic, "RGGB").Short(50712, squares));
  for (uint16_t& value : mosaic.pixels()) value = static_cast<uint16_t>(value * value);
  EXPECT_EQ(RawPixelsOf(read), mosaic.pixels());
}

TEST(RawImage, AMonochromeSensorGivesGrey) {
  const Image<uint16_t> mosaic = Mosaic();
  TestDng dng(mosaic, "RGGB");
  const ImageWithInfo read = Read(dng.Short(262, {34892}).Without(33421).Without(33422));
  EXPECT_EQ(RawPixelsOf(read), mosaic.pixels());
  EXPECT_TRUE(read.info.raw.value().is_monochrome);
  EXPECT_EQ(read.info.raw->bayer, BayerPattern::kNone);
  EXPECT_FALSE(Read(TestDng(mosaic, "RGGB")).info.raw.value().is_monochrome);
}

TEST(RawImage, TheOrientationIsToldButNotApplied) {
  for (uint32_t orientation = 1; orientation <= 8; ++orientation)
    EXPECT_EQ(Read(TestDng(Mosaic(), "RGGB").Short(274, {orientation})).info.orientation,
              static_cast<int>(orientation));
}

// MaskedAreas are pixels on which a reader may measure the black level, but BlackLevel states it.
TEST(RawImage, CoveredPixelsDoNotReplaceTheStatedBlackLevel) {
  TestDng dng(Mosaic(60, 50), "BGGR");
  dng.Long(50829, {2, 4, 46, 57}).Long(50830, {0, 0, 50, 4}).Short(50714, {300});
  EXPECT_EQ(Read(dng).info.raw.value().black_level, 300);
  TestDng deltas(Mosaic(40, 30), "BGGR");
  std::vector<std::pair<int, int>> columns(40, {0, 1});
  for (size_t x = 0; x < 40; x += 2) columns[x].first = 3;
  deltas.Short(50714, {300}).Fractions(50715, 10, columns);
  EXPECT_EQ(Read(deltas).info.raw.value().black_level, 301.5);
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

// LibRaw makes odd margins even. The pattern must still be the one that begins at the corner of the
// active area.
TEST(RawImage, TheActiveAreaIsTheImage) {
  const Image<uint16_t> mosaic = Mosaic(60, 50);
  for (const auto& [top, left] : {std::pair(2, 4), {3, 4}, {2, 5}, {3, 5}})
    for (const char* pattern : kPatterns) {
      TestDng dng(mosaic, pattern);
      dng.Long(50829, {static_cast<uint32_t>(top), static_cast<uint32_t>(left), 46, 57});
      const ImageWithInfo read = Read(dng);
      ASSERT_EQ(read.info.width, 57 - left);
      ASSERT_EQ(read.info.height, 46 - top);
      for (int y = 0; y < read.info.height; ++y)
        for (int x = 0; x < read.info.width; ++x)
          ASSERT_EQ(std::get<Image<uint16_t>>(read.image).at(x, y), mosaic.at(x + left, y + top));
      EXPECT_EQ(read.info.raw->bayer, Read(TestDng(mosaic, pattern)).info.raw->bayer)
          << top << " " << left << " " << pattern;
    }
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
  TestDng beyond(Mosaic(), "RGGB");
  EXPECT_FALSE(Read(beyond.Long(50714, {70000})).info.raw->black_level);
}

// Camera RGB is ColorMatrix1 times XYZ, with rows balanced so that white gives 1, 1, 1 (DNG 1.4,
// chapter 6).
TEST(RawImage, ColoursAreThoseOfTheTags) {
  TestDng dng(Mosaic(), "RGGB");
  const RawFacts unknown = *Read(dng).info.raw;
  EXPECT_FALSE(unknown.white_balance);
  EXPECT_FALSE(unknown.linear_srgb_from_camera);
  dng.Fractions(50728, 5, {{1, 2}, {1, 1}, {4, 5}}).Short(50778, {21});
  dng.Fractions(50721, 10,
                {{1, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 1}});
  const RawFacts facts = *Read(dng).info.raw;
  ASSERT_TRUE(facts.white_balance && facts.linear_srgb_from_camera);
  EXPECT_NEAR((*facts.white_balance)[0], 2, 1e-6);
  EXPECT_EQ((*facts.white_balance)[1], 1);
  EXPECT_NEAR((*facts.white_balance)[2], 1.25, 1e-6);
  Mat3 xyz_from_srgb;  // IEC 61966-2-1
  xyz_from_srgb << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Vec3 white = xyz_from_srgb * Vec3::Ones();
  const Mat3 camera_from_srgb = white.cwiseInverse().asDiagonal() * xyz_from_srgb;
  EXPECT_LT(
      (*facts.linear_srgb_from_camera * camera_from_srgb - Mat3::Identity()).cwiseAbs().maxCoeff(),
      2e-3);
}

TEST(RawImage, WhatIsNoBayerMosaicIsRefused) {
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(33421, {6, 6}), "X-Trans");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(262, {34892}).Short(277, {3}), "linear DNG");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(262, {2}), "does not state its mosaic");
  for (const uint32_t layout : {2, 3, 5})
    ExpectFault(TestDng(Mosaic(), "RGGB").Short(50711, {layout}), "staggered");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(339, {3}), "floating point");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(277, {3}), "3 channels");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(258, {32}), "32 bits");
  ExpectFault(TestDng(Mosaic(21, 21), "RGGB"), "22 x 22");
  ExpectFault(TestDng(Mosaic(), "RGGB").Tiled(16, 16, false), "uncompressed tiles");
}

TEST(RawImage, AFileCutAnywhereIsAnError) {
  const std::string whole = TestDng(Mosaic(), "RGGB").File();
  for (size_t size = 0; size < whole.size(); size += size < 600 ? 1 : 97)
    ErrorOf(whole.substr(0, size));
  ErrorOf(whole.substr(0, whole.size() - 1));
}

// The last two bytes of the picture's data are an end mark, which no decoder needs.
TEST(RawImage, ACompressedFileCutAnywhereIsAnError) {
  const std::string whole = TestDng(Mosaic(80, 60), "RGGB").Tiled(32, 32, true).File();
  for (size_t size = 0; size + 2 < whole.size(); size += 1 + size / 200)
    ErrorOf(whole.substr(0, size));
  ErrorOf(whole.substr(0, whole.size() - 3));
}

// If a tile does not begin as JPEG, LibRaw stops decoding without an error.
TEST(RawImage, ADamagedTileIsAnError) {
  const std::string whole = TestDng(Mosaic(66, 34), "RGGB").Tiled(32, 32, true).File();
  size_t count = 0;
  for (size_t at = whole.find("\xff\xd8\xff\xc4"); at != std::string::npos;
       at = whole.find("\xff\xd8\xff\xc4", at + 1), ++count) {
    std::string damaged = whole;
    damaged[at + 1] = 0;
    ErrorOf(damaged);
  }
  EXPECT_EQ(count, 6u);
}

TEST(RawImage, ClaimsAreCheckedBeforeLibRawBelievesThem) {
  ExpectFault(TestDng(Mosaic(), "RGGB").Long(256, {40000}).Long(257, {40000}), "more than the");
  ErrorOf(TestDng(Mosaic(), "RGGB").Long(256, {65536}).Long(257, {65536}).File());
  ErrorOf(TestDng(Mosaic(), "RGGB").Long(257, {31}).File());
  ExpectFault(TestDng(Mosaic(), "RGGB").Long(257, {64}), "too short");
  ExpectFault(TestDng(Mosaic(), "RGGB").Short(259, {7}).Long(257, {60000}), "too short");
  ExpectFault(TestDng(Mosaic(), "RGGB").Without(273), "where its pixels are");
  ErrorOf(TestDng(Mosaic(), "RGGB").Long(256, {0}).File());
  ErrorOf(TestDng(Mosaic(), "RGGB").Long(50829, {0, 0, 31, 40}).File());
  for (const auto& area : {std::vector<uint32_t>{1, 1, 31, 40}, {1, 1, 30, 41}})
    ExpectFault(TestDng(Mosaic(), "RGGB").Long(50829, area), "active area");
  ErrorOf(TestDng(Mosaic(), "RGGB").Long(50829, {20, 20, 10, 10}).File());
}

// LibRaw's objects share no state, so each thread can use its own.
TEST(RawImage, ManyThreadsReadAtTheSameTime) {
  const Image<uint16_t> noise = Mosaic(75, 50);
  const std::string file = TestDng(noise, "GBRG").Tiled(16, 16, true).File();
  std::atomic<int> wrong_count = 0;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k) {
        const Result<StoredImage> read = ReadImageBytes(file, "a.dng");
        wrong_count += !read || std::get<Image<uint16_t>>(*read).pixels() != noise.pixels() ? 1 : 0;
      }
    });
  threads.clear();
  EXPECT_EQ(wrong_count, 0);
}

class RawFileTest : public FolderTest {
 protected:
  // Returns all pixels of the sensor, as LibRaw's program `unprocessed_raw` writes them.
  Image<uint16_t> SensorByLibRaw(const TestDng& dng) {
    const std::string path = (folder_ / "a.dng").string();
    EXPECT_TRUE(WriteFileAtomically(path, dng.File()));
    EXPECT_EQ(std::system(("unprocessed_raw -q '" + path + "'").c_str()), 0);
    std::ifstream file(path + ".pgm", std::ios::binary);
    std::string magic;
    int width = 0, height = 0, largest = 0;
    file >> magic >> width >> height >> largest;
    file.get();
    Image<uint16_t> sensor(width, height, 1);
    for (uint16_t& value : sensor.pixels()) {
      const int high = file.get(), low = file.get();
      value = static_cast<uint16_t>(high << 8 | low);
    }
    EXPECT_TRUE(file) << path;
    return sensor;
  }

  // Compares the image that we read with the pixels of LibRaw's program, whose pixel (left, top) is
  // our pixel (0, 0).
  void ExpectAsByLibRaw(const TestDng& dng, int left, int top) {
    const Image<uint16_t> sensor = SensorByLibRaw(dng);
    const Result<StoredImage> read = ReadImage(folder_ / "a.dng");
    ASSERT_TRUE(read) << read.error().message;
    const auto& image = std::get<Image<uint16_t>>(*read);
    ASSERT_LE(left + image.width(), sensor.width());
    ASSERT_LE(top + image.height(), sensor.height());
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        ASSERT_EQ(image.at(x, y), sensor.at(left + x, top + y)) << x << " " << y;
  }
};

TEST_F(RawFileTest, PixelsAreThoseOfLibRawsOwnProgram) {
  const Image<uint16_t> words = Mosaic(75, 52);
  Image<uint16_t> few_bits = words;
  for (uint16_t& value : few_bits.pixels()) value >>= 4;
  for (const bool has_margins : {false, true}) {
    const auto expect = [&](TestDng dng) {
      if (has_margins) {
        dng.Long(50829, {3, 5, 50, 70});
        dng.Long(50719, {4, 2}).Long(50720, {40, 30});  // default crop, for developed pictures only
      }
      ExpectAsByLibRaw(dng.Short(50714, {64}), has_margins ? 5 : 0, has_margins ? 3 : 0);
    };
    expect(TestDng(words, "RGGB"));
    expect(TestDng(few_bits, "GRBG").Packed(12));
    expect(TestDng(few_bits, "GBRG").Packed(14));
    expect(TestDng(words, "BGGR").Tiled(32, 16, true));
  }
}

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
