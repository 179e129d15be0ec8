// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/folder_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/light_field/model/brackets.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_dng.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/pixels/files/upright.h"
#include "lf/pixels/files/write_jpeg.h"
#include "lf/storage/load/demosaic.h"

namespace lf {
namespace {

constexpr int kWidth = 7, kHeight = 5;
constexpr PixelRect kWhole = {0, 0, kWidth, kHeight};

class FolderStoreTest : public FolderTest {
 protected:
  // Returns a light field of one image, "a.png". The tests write the file.
  LightField OneImage(const std::string& name = "a.png") const {
    LightField light_field;
    light_field.cameras.resize(1);
    light_field.intrinsics = {{10, 10, 3.5, 2.5, 0, kWidth, kHeight}};
    light_field.image_names = {name};
    light_field.folder = folder_;
    return light_field;
  }
  template <class T>
  Image<T> Write(const std::string& name, int channels, int width = kWidth, int height = kHeight) {
    const Image<T> image = NoiseImage<T>(width, height, channels);
    const Result<void> written = WriteImage(folder_ / name, image.view());
    EXPECT_TRUE(written) << written.error().message;
    return image;
  }
  void WriteFloats(const std::string& name, const Image<float>& image,
                   const std::vector<std::string>& channel_names) {
    ASSERT_TRUE(WriteImage(folder_ / name, image.view(), channel_names, PixelType::kFloat));
  }
};

LfPixels Loaded(const LightField& light_field, const PixelRect& rect = kWhole) {
  LfPixels pixels;
  const Result<void> loaded = FolderStore(light_field).Load({0}, rect, &pixels);
  EXPECT_TRUE(loaded) << loaded.error().message;
  return pixels;
}

bool HasMasked(const LfPixels& pixels) {
  for (int y = 0; y < pixels.rect.height(); ++y)
    for (int x = 0; x < pixels.rect.width(); ++x)
      if (pixels.IsMasked(x, y)) return true;
  return false;
}

std::string ErrorOf(const LightField& light_field) {
  LfPixels pixels;
  const Result<void> loaded = FolderStore(light_field).Load({0}, kWhole, &pixels);
  EXPECT_FALSE(loaded);
  return loaded ? "" : loaded.error().message;
}

void ExpectMentions(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

TEST_F(FolderStoreTest, ColoursGoThroughTheTable) {
  const Image<uint8_t> stored = Write<uint8_t>("a.png", 3);
  const LightField light_field = OneImage();
  const LfPixels pixels = Loaded(light_field);
  const std::vector<uint16_t> table = RadianceTable(light_field.encoding, 8, 1);
  ASSERT_EQ(pixels.radiance.channels(), 4);
  EXPECT_EQ(pixels.rect, kWhole);
  EXPECT_EQ(pixels.bayer, BayerPattern::kNone);
  EXPECT_FALSE(HasMasked(pixels));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(pixels.radiance.at(x, y, c), table[stored.at(x, y, c)]);
}

TEST_F(FolderStoreTest, ARectangleIsThePartOfTheWhole) {
  Write<uint8_t>("a.png", 4);
  const LfPixels whole = Loaded(OneImage());
  ASSERT_TRUE(HasMasked(whole));
  const PixelRect rect = {2, 1, 6, 4};
  const LfPixels part = Loaded(OneImage(), rect);
  EXPECT_EQ(part.rect, rect);
  ASSERT_EQ(part.radiance.width(), 4);
  ASSERT_EQ(part.radiance.height(), 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) {
      EXPECT_EQ(part.IsMasked(x, y), whole.IsMasked(x + 2, y + 1));
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(part.radiance.at(x, y, c), whole.radiance.at(x + 2, y + 1, c));
    }
}

TEST_F(FolderStoreTest, ARectangleIsCutToTheImage) {
  Write<uint8_t>("a.png", 3);
  EXPECT_EQ(Loaded(OneImage(), {-3, 2, 100, 100}).rect, (PixelRect{0, 2, kWidth, kHeight}));
  EXPECT_TRUE(Loaded(OneImage(), {50, 50, 60, 60}).radiance.empty());
}

// The file is a JPEG that is decoded in part, with an orientation tag that exchanges width and
// height.
TEST_F(FolderStoreTest, ARectangleOfATurnedImageIsThePartOfTheTurnedWhole) {
  constexpr PixelRect kStoredWhole = {0, 0, 45, 37};
  const std::string jpeg = EncodeJpeg(NoiseImage<uint8_t>(45, 37, 3).view(), 90).value();
  ASSERT_TRUE(WriteFileAtomically(folder_ / "stored.jpg", jpeg));
  LightField as_stored = OneImage("stored.jpg"), upright = OneImage("turned.jpg");
  as_stored.intrinsics = {{10, 10, 22, 18, 0, 45, 37}};
  upright.intrinsics = {{10, 10, 18, 22, 0, 37, 45}};
  const LfPixels stored = Loaded(as_stored, kStoredWhole);
  for (char orientation = 5; orientation <= 8; ++orientation) {
    // Exif with one tag: orientation (0x112), one short.
    std::string exif("Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\0\0\0\0\0\0\0", 32);
    exif[25] = orientation;
    const std::string app1 = {'\xff', '\xe1', 0, static_cast<char>(exif.size() + 2)};
    ASSERT_TRUE(WriteFileAtomically(folder_ / "turned.jpg",
                                    jpeg.substr(0, 2) + app1 + exif + jpeg.substr(2)));
    const Image<uint16_t> expected = Upright(stored.radiance, orientation);
    for (const PixelRect& rect :
         {PixelRect{0, 0, 37, 45}, {20, 5, 36, 30}, {1, 40, 9, 45}, {0, 0, 3, 2}}) {
      const LfPixels pixels = Loaded(upright, rect);
      ASSERT_EQ(pixels.rect, rect);
      for (int y = rect.y_begin; y < rect.y_end; ++y)
        for (int x = rect.x_begin; x < rect.x_end; ++x)
          for (int c = 0; c < 3; ++c)
            ASSERT_EQ(pixels.radiance.at(x - rect.x_begin, y - rect.y_begin, c),
                      expected.at(x, y, c))
                << int{orientation} << ": " << x << ", " << y;
    }
  }
}

// Returns a grey picture, in which one channel of each pixel of the first row is brighter: first,
// first + step, ... in 8 bits.
Image<uint8_t> Bright(uint8_t first, uint8_t step) {
  Image<uint8_t> image(kWidth, kHeight, 3, uint8_t{100});
  for (int x = 0; x < kWidth; ++x) image.at(x, 0, x % 3) = static_cast<uint8_t>(first + x * step);
  return image;
}

TEST_F(FolderStoreTest, AClippedChannelMasksAPixelWhereThatIsAskedFor) {
  ASSERT_TRUE(WriteImage(folder_ / "a.png", Bright(249, 1).view()));
  LightField light_field = OneImage();
  EXPECT_FALSE(HasMasked(Loaded(light_field)));
  light_field.cameras[0].masks_clipped = true;
  const LfPixels pixels = Loaded(light_field);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) EXPECT_EQ(pixels.IsMasked(x, y), y == 0 && x >= 4) << x;
}

TEST_F(FolderStoreTest, PixelsAreClippedFromTheWhiteLevelOn) {
  ASSERT_TRUE(WriteImage(folder_ / "a.png", Bright(194, 1).view()));
  LightField light_field = OneImage();
  light_field.cameras[0].masks_clipped = true;
  EXPECT_FALSE(HasMasked(Loaded(light_field)));
  light_field.encoding.black_level = 100;
  light_field.encoding.white_level = 200;  // clipped from 199 on
  const LfPixels pixels = Loaded(light_field);
  for (int x = 0; x < kWidth; ++x) EXPECT_EQ(pixels.IsMasked(x, 0), x >= 5) << x;
}

// Two exposures of one pose: the bright one clips three pixels of the first row.
TEST_F(FolderStoreTest, ADarkerImageHasWhatTheBrighterOneClipsAndAPixelAround) {
  ASSERT_TRUE(WriteImage(folder_ / "a.png", Image<uint8_t>(kWidth, kHeight, 3, 60).view()));
  Image<uint8_t> bright(kWidth, kHeight, 3, 200);
  for (int x = 0; x < 3; ++x) bright.at(x, 0, 1) = 255;
  ASSERT_TRUE(WriteImage(folder_ / "b.png", bright.view()));
  LightField light_field = OneImage();
  light_field.cameras.resize(2);
  light_field.image_names.push_back("b.png");
  light_field.encoding.masks_clipped = true;
  light_field.cameras[0].gain = 4;
  ASSERT_EQ(ApplyBrackets(&light_field), 1U);
  LfPixels of_bright;
  ASSERT_TRUE(FolderStore(light_field).Load({1}, kWhole, &of_bright));
  const LfPixels of_dark = Loaded(light_field);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_EQ(of_bright.IsMasked(x, y), y == 0 && x < 3);
      EXPECT_EQ(of_dark.IsMasked(x, y), y > 1 || x > 3);
    }
  const LfPixels part = Loaded(light_field, {3, 1, 6, 3});
  for (int y = 1; y < 3; ++y)
    for (int x = 3; x < 6; ++x) EXPECT_EQ(part.IsMasked(x - 3, y - 1), y > 1 || x > 3);
  std::filesystem::remove(folder_ / "b.png");
  EXPECT_FALSE(HasMasked(Loaded(light_field)));
}

TEST_F(FolderStoreTest, FloatsAreNeverClipped) {
  Image<float> image(kWidth, kHeight, 3, 1000.F);
  WriteFloats("a.exr", image, {"R", "G", "B"});
  LightField light_field = OneImage("a.exr");
  light_field.cameras[0].masks_clipped = true;
  EXPECT_FALSE(HasMasked(Loaded(light_field)));
}

TEST_F(FolderStoreTest, GreyCountsForAllColours) {
  const Image<uint16_t> stored = Write<uint16_t>("a.png", 1);
  LightField light_field = OneImage();
  light_field.encoding.transfer = Transfer::kLinear;
  const LfPixels pixels = Loaded(light_field);
  ASSERT_EQ(pixels.radiance.channels(), 4);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(pixels.radiance.at(x, y, c), stored.at(x, y));
}

TEST_F(FolderStoreTest, AMosaicKeepsItsOneChannel) {
  const Image<uint16_t> stored = Write<uint16_t>("a.png", 1);
  LightField light_field = OneImage();
  light_field.encoding.transfer = Transfer::kLinear;
  light_field.encoding.bayer = BayerPattern::kGbrg;
  const LfPixels pixels = Loaded(light_field);
  EXPECT_EQ(pixels.bayer, BayerPattern::kGbrg);
  EXPECT_EQ(pixels.radiance.channels(), 1);
  EXPECT_EQ(pixels.radiance.pixels(), stored.pixels());
}

TEST_F(FolderStoreTest, AMosaicBecomesRgbWhereItIsAskedTo) {
  Write<uint16_t>("a.png", 1);
  LightField light_field = OneImage();
  light_field.encoding.transfer = Transfer::kLinear;
  light_field.encoding.bayer = BayerPattern::kGbrg;
  light_field.encoding.white_balance = {2, 1, 1.5};
  const LfPixels mosaic = Loaded(light_field);
  LfPixels expected;
  DemosaicReference(mosaic, kWidth, kHeight, light_field.encoding, kWhole, &expected);
  const FolderStore store(light_field, Mosaics::kToRgb);
  LfPixels pixels;
  ASSERT_TRUE(store.Load({0}, kWhole, &pixels));
  EXPECT_EQ(pixels.bayer, BayerPattern::kNone);
  EXPECT_EQ(pixels.radiance.pixels(), expected.radiance.pixels());
  // The pixels of a rectangle are a part of the whole image, even if the rectangle reaches beyond
  // it.
  ASSERT_TRUE(store.Load({0}, {1, 1, kWidth + 3, kHeight}, &pixels));
  EXPECT_EQ(pixels.rect, (PixelRect{1, 1, kWidth, kHeight}));
  for (int y = 1; y < kHeight; ++y)
    for (int x = 1; x < kWidth; ++x)
      for (int c = 0; c < 4; ++c)
        ASSERT_EQ(pixels.radiance.at(x - 1, y - 1, c), expected.radiance.at(x, y, c));
  ASSERT_TRUE(store.Load({0}, {kWidth + 5, 0, kWidth + 9, 2}, &pixels));
  EXPECT_TRUE(pixels.rect.empty());
  // Images that are no mosaics stay unchanged.
  light_field.encoding.bayer = BayerPattern::kNone;
  const LfPixels grey = Loaded(light_field);
  ASSERT_TRUE(FolderStore(light_field, Mosaics::kToRgb).Load({0}, kWhole, &pixels));
  EXPECT_EQ(pixels.radiance.pixels(), grey.radiance.pixels());
}

TEST_F(FolderStoreTest, RowsAreToldAsSoonAsTheyAreComplete) {
  LightField light_field = OneImage();
  light_field.intrinsics = {{10, 10, 3.5, 2.5, 0, 700, 60}};
  for (const int channels : {3, 4}) {
    Write<uint8_t>("a.png", channels, 700, 60);
    const LfPixels whole = Loaded(light_field, {0, 0, 700, 60});
    LfPixels pixels;
    std::vector<int> counts;
    ASSERT_TRUE(FolderStore(light_field)
                    .LoadByRows({0}, {0, 0, 700, 60}, &pixels, [&](LfPixels* rows, int row_count) {
                      counts.push_back(row_count);
                      EXPECT_EQ(rows->any_masked, whole.any_masked);
                      EXPECT_TRUE(std::equal(rows->radiance.row(0),
                                             rows->radiance.row(row_count - 1) + 4 * 700,
                                             whole.radiance.row(0)));
                    }));
    // Alpha masks pixels after all rows were converted.
    EXPECT_EQ(counts, channels == 3 ? std::vector({23, 46, 60}) : std::vector({60}));
  }
}

TEST_F(FolderStoreTest, AMosaicOfOneRowIsAnError) {
  Write<uint16_t>("a.png", 1, kWidth, 1);
  LightField light_field = OneImage();
  light_field.intrinsics[0].height_px = 1;
  light_field.encoding.bayer = BayerPattern::kGbrg;
  LfPixels pixels;
  const Result<void> loaded = FolderStore(light_field, Mosaics::kToRgb).Load({0}, kWhole, &pixels);
  ASSERT_FALSE(loaded);
  ExpectMentions(loaded.error().message, {"a.png", "x 1 pixels", "2 x 2"});
}

TEST_F(FolderStoreTest, AMosaicWithThreeChannelsIsAnError) {
  Write<uint8_t>("a.png", 3);
  LightField light_field = OneImage();
  light_field.encoding.bayer = BayerPattern::kRggb;
  ExpectMentions(ErrorOf(light_field), {"a.png: has 3 channels", "lf_bayer"});
}

TEST_F(FolderStoreTest, ARawFileGivesTheBitsOfTheSameMosaicAsPng) {
  const Image<uint16_t> mosaic = NoiseImage<uint16_t>(24, 23, 1);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", mosaic.view()));
  TestDng dng(mosaic, "GBRG");
  dng.Long(50714, {512}).Long(50717, {16383}).Short(274, {6});
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.dng", dng.File()));
  LightField light_field = OneImage();
  light_field.intrinsics[0].width_px = 24;
  light_field.intrinsics[0].height_px = 23;
  light_field.encoding.bayer = BayerPattern::kGbrg;
  light_field.encoding.transfer = Transfer::kLinear;
  light_field.encoding.black_level = 512;
  light_field.encoding.white_level = 16383;
  light_field.encoding.pedestal = 1024;
  const LfPixels png = Loaded(light_field, {0, 0, 24, 23});
  light_field.image_names = {"a.dng"};
  const LfPixels raw = Loaded(light_field, {0, 0, 24, 23});
  EXPECT_EQ(raw.radiance.pixels(), png.radiance.pixels());
  EXPECT_EQ(raw.bayer, png.bayer);
}

TEST_F(FolderStoreTest, ARawFileMustHaveThePatternOfTheLightField) {
  const Image<uint16_t> mosaic = NoiseImage<uint16_t>(24, 23, 1);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.dng", TestDng(mosaic, "GBRG").File()));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "untold.dng", TestDng(mosaic, "RGBG").File()));
  LightField light_field = OneImage("a.dng");
  light_field.intrinsics[0].width_px = 24;
  light_field.intrinsics[0].height_px = 23;
  ExpectMentions(ErrorOf(light_field), {"a.dng: is a camera raw file", "lf_bayer"});
  light_field.encoding.bayer = BayerPattern::kRggb;
  ExpectMentions(ErrorOf(light_field),
                 {"a.dng: has the Bayer pattern GBRG", "light field has RGGB"});
  light_field.image_names = {"untold.dng"};
  EXPECT_EQ(Loaded(light_field).bayer, BayerPattern::kRggb);
}

TEST_F(FolderStoreTest, ARawFileWithoutColourFilterIsGreyLight) {
  const Image<uint16_t> grey = NoiseImage<uint16_t>(24, 23, 1);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", grey.view()));
  TestDng dng(grey, "RGGB");
  dng.Short(262, {34892}).Without(33421).Without(33422);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.dng", dng.File()));
  LightField light_field = OneImage();
  light_field.intrinsics[0].width_px = 24;
  light_field.intrinsics[0].height_px = 23;
  light_field.encoding.transfer = Transfer::kLinear;
  const LfPixels png = Loaded(light_field, {0, 0, 24, 23});
  light_field.image_names = {"a.dng"};
  EXPECT_EQ(Loaded(light_field, {0, 0, 24, 23}).radiance.pixels(), png.radiance.pixels());
  light_field.encoding.bayer = BayerPattern::kRggb;
  ExpectMentions(ErrorOf(light_field), {"a.dng", "without a colour filter", "lf_bayer"});
  light_field.encoding.bayer = BayerPattern::kNone;
  light_field.encoding.transfer = Transfer::kSrgb;
  ExpectMentions(ErrorOf(light_field), {"a.dng", "without a colour filter", "sRGB"});
}

TEST_F(FolderStoreTest, AlphaBelowOneHalfMasks) {
  Image<uint8_t> stored = NoiseImage<uint8_t>(kWidth, kHeight, 4);
  for (int i = 0; i < kWidth * kHeight; ++i) stored.pixels()[4 * i + 3] = i % 2 ? 255 : 128;
  stored.at(3, 2, 3) = 127;
  stored.at(4, 2, 3) = 0;
  ASSERT_TRUE(WriteImage(folder_ / "a.png", stored.view()));
  const LfPixels pixels = Loaded(OneImage());
  ASSERT_TRUE(HasMasked(pixels));
  EXPECT_EQ(pixels.radiance.channels(), 4);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      EXPECT_EQ(pixels.IsMasked(x, y), y == 2 && (x == 3 || x == 4)) << x << " " << y;
}

TEST_F(FolderStoreTest, OpaqueImagesHaveNoMask) {
  Image<uint16_t> stored(kWidth, kHeight, 4, 65535);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", stored.view()));
  EXPECT_FALSE(HasMasked(Loaded(OneImage())));
}

TEST_F(FolderStoreTest, GreyWithAlphaIsBoth) {
  Image<uint8_t> stored(kWidth, kHeight, 2, 255);
  stored.at(1, 1, 0) = 0;
  stored.at(2, 1, 1) = 0;
  ASSERT_TRUE(WriteImage(folder_ / "a.png", stored.view()));
  const LfPixels pixels = Loaded(OneImage());
  EXPECT_EQ(pixels.radiance.at(1, 1, 2), 0);
  ASSERT_TRUE(HasMasked(pixels));
  EXPECT_FALSE(pixels.IsMasked(1, 1));
  EXPECT_TRUE(pixels.IsMasked(2, 1));
}

TEST_F(FolderStoreTest, AMaskFileTakesRaysAway) {
  Write<uint8_t>("a.png", 3);
  Image<uint8_t> mask(kWidth, kHeight, 1, 1);
  mask.at(6, 4) = 0;
  ASSERT_TRUE(WriteImage(folder_ / "m.png", mask.view()));
  LightField light_field = OneImage();
  light_field.mask_names = {"m.png"};
  const LfPixels pixels = Loaded(light_field, {5, 3, 7, 5});
  ASSERT_TRUE(HasMasked(pixels));
  EXPECT_TRUE(pixels.IsMasked(1, 1));
  EXPECT_FALSE(pixels.IsMasked(0, 1));
  light_field.mask_names = {""};
  EXPECT_FALSE(HasMasked(Loaded(light_field)));
}

TEST_F(FolderStoreTest, AMaskOfAnotherSizeOrNoMaskIsAnError) {
  Write<uint8_t>("a.png", 3);
  Write<uint8_t>("m.png", 1, kWidth, kHeight + 1);
  LightField light_field = OneImage();
  light_field.mask_names = {"m.png"};
  ExpectMentions(ErrorOf(light_field), {"m.png: has 7 x 6 pixels", "7 x 5"});
  light_field.mask_names = {"none.png"};
  ExpectMentions(ErrorOf(light_field), {"none.png"});
}

TEST_F(FolderStoreTest, GainBelongsToTheImage) {
  const Image<uint8_t> stored = Write<uint8_t>("a.png", 3);
  LightField light_field = OneImage();
  light_field.cameras.push_back(light_field.cameras[0]);
  light_field.image_names.push_back("a.png");
  light_field.cameras[1].gain = 0.5f;
  const FolderStore store(light_field);
  LfPixels plain, dimmed;
  ASSERT_TRUE(store.Load({0}, kWhole, &plain));
  ASSERT_TRUE(store.Load({1}, kWhole, &dimmed));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(dimmed.radiance.at(x, y, c), plain.radiance.at(x, y, c) / 2.0, 0.51);
}

TEST_F(FolderStoreTest, GainOfAMosaicLeavesBlackOnThePedestal) {
  Image<uint16_t> stored(kWidth, kHeight, 1, 512);
  stored.at(1, 0) = 512 + 1000;
  stored.at(2, 0) = 512 - 100;
  ASSERT_TRUE(WriteImage(folder_ / "a.png", stored.view()));
  LightField light_field = OneImage();
  light_field.cameras[0].gain = 0.5f;
  light_field.encoding.bayer = BayerPattern::kRggb;
  light_field.encoding.transfer = Transfer::kLinear;
  light_field.encoding.black_level = 512;
  light_field.encoding.white_level = 4095;
  light_field.encoding.pedestal = 1024;
  const LfPixels pixels = Loaded(light_field);
  const double step = (65535 - 1024) / (4095.0 - 512) / 2;
  EXPECT_EQ(pixels.radiance.at(0, 0), 1024);
  EXPECT_EQ(pixels.radiance.at(1, 0), 1024 + std::lround(1000 * step));
  EXPECT_EQ(pixels.radiance.at(2, 0), 1024 - std::lround(100 * step));
}

TEST_F(FolderStoreTest, FloatsAreRadianceItself) {
  Image<float> stored(kWidth, kHeight, 3, 0.25f);
  stored.at(0, 0, 0) = 1;
  stored.at(0, 0, 1) = 40;
  stored.at(0, 0, 2) = -1;
  stored.at(1, 0, 0) = std::numeric_limits<float>::quiet_NaN();
  WriteFloats("a.exr", stored, {"R", "G", "B"});
  LightField light_field = OneImage("a.exr");
  light_field.encoding.max_radiance = 16;
  light_field.encoding.black_level = 60000;  // has no effect on float files
  light_field.cameras[0].gain = 2;
  const LfPixels pixels = Loaded(light_field);
  EXPECT_EQ(pixels.radiance.at(0, 0, 0), std::lround(65535 / 8.0));
  EXPECT_EQ(pixels.radiance.at(0, 0, 1), 65535);
  EXPECT_EQ(pixels.radiance.at(0, 0, 2), 0);
  EXPECT_EQ(pixels.radiance.at(1, 0, 0), 0);
  EXPECT_EQ(pixels.radiance.at(1, 1, 0), std::lround(65535 / 32.0));
  EXPECT_FALSE(HasMasked(pixels));
}

TEST_F(FolderStoreTest, DepthBesideTheColoursIsNoAlpha) {
  const Image<float> stored(kWidth, kHeight, 4, 0.25f);
  WriteFloats("a.exr", stored, {"R", "G", "B", "Z"});
  EXPECT_FALSE(HasMasked(Loaded(OneImage("a.exr"))));
  WriteFloats("b.exr", stored, {"R", "G", "B", "A"});
  EXPECT_TRUE(HasMasked(Loaded(OneImage("b.exr"))));
}

TEST_F(FolderStoreTest, AnImageOfAnotherSizeIsAnErrorThatNamesBoth) {
  Write<uint8_t>("a.png", 3, kWidth + 1, kHeight);
  ExpectMentions(ErrorOf(OneImage()), {"a.png: has 8 x 5 pixels", "calibration says 7 x 5"});
}

TEST_F(FolderStoreTest, LevelsBeyondTheFilesBitsAreAnError) {
  Write<uint8_t>("a.png", 3);
  LightField light_field = OneImage();
  light_field.encoding.white_level = 4095;
  ExpectMentions(ErrorOf(light_field), {"a.png: contains values of 8 bits", "4095"});
}

TEST_F(FolderStoreTest, MissingAndBrokenImagesAreErrorsThatNameThem) {
  ExpectMentions(ErrorOf(OneImage()), {"a.png"});
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.png", "no picture"));
  ExpectMentions(ErrorOf(OneImage()), {"a.png"});
}

}  // namespace
}  // namespace lf
