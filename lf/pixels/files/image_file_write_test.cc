// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <csignal>
#include <limits>
#include <regex>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class WriteImageTest : public FolderTest {
 protected:
  bool FileContains(const std::string& name, const std::string& text) const {
    return ReadFile(folder_ / name).value().find(text) != std::string::npos;
  }
};

template <class T>
void ExpectSame(const Result<StoredImage>& read, const Image<T>& expected) {
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(std::holds_alternative<Image<T>>(*read));
  const Image<T>& image = std::get<Image<T>>(*read);
  EXPECT_EQ(image.width(), expected.width());
  EXPECT_EQ(image.height(), expected.height());
  EXPECT_EQ(image.channels(), expected.channels());
  EXPECT_EQ(image.pixels(), expected.pixels());
}

TEST_F(WriteImageTest, IntegersComeBackBitForBit) {
  for (const char* name : {"a.png", "a.tif", "b.TIFF"})
    for (int channels = 1; channels <= 4; ++channels) {
      const auto bytes = NoiseImage<uint8_t>(13, 7, channels);
      ASSERT_TRUE(WriteImage(folder_ / name, bytes.view()));
      ExpectSame(ReadImage(folder_ / name), bytes);
      const auto words = NoiseImage<uint16_t>(13, 7, channels);
      ASSERT_TRUE(WriteImage(folder_ / name, words.view()));
      ExpectSame(ReadImage(folder_ / name), words);
    }
}

TEST_F(WriteImageTest, PicturesOfManyBlocksOfRowsComeBackBitForBit) {
  for (const int height : {31, 32, 33, 100}) {
    const auto words = NoiseImage<uint16_t>(23, height, 3);
    for (const char* name : {"a.png", "a.tif"}) {
      ASSERT_TRUE(WriteImage(folder_ / name, words.view()));
      ExpectSame(ReadImage(folder_ / name), words);
    }
    Image<float> floats(23, height, 3);
    std::copy(words.pixels().begin(), words.pixels().end(), floats.pixels().begin());
    for (const char* name : {"a.exr", "b.tif"}) {
      ASSERT_TRUE(WriteImage(folder_ / name, floats.view(), {"R", "G", "B"}, PixelType::kFloat));
      ExpectSame(ReadImage(folder_ / name), floats);
    }
  }
}

TEST_F(WriteImageTest, AnInterruptionLeavesTheOldFileAlone) {
  const auto picture = NoiseImage<uint8_t>(23, 100, 3);
  Image<float> floats(23, 100, 3);
  for (const char* name : {"a.png", "a.tif", "a.jpg"}) {
    ASSERT_TRUE(WriteImage(folder_ / name, picture.view()));
    const std::string before = ReadFile(folder_ / name).value();
    int asked = 0;
    const auto result = WriteImage(folder_ / name, floats.view(), {"R", "G", "B"},
                                   PixelType::kUint8, {}, [&] { return ++asked == 3; });
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::kInterrupted);
    EXPECT_EQ(asked, 3);
    EXPECT_EQ(ReadFile(folder_ / name).value(), before);
  }
}

TEST_F(WriteImageTest, AViewWithinAPictureIsWrittenAlone) {
  const auto picture = NoiseImage<uint16_t>(9, 6, 3);
  ImageView<const uint16_t> part = picture.view();
  part.data = &picture.at(2, 1);
  part.width = 4;
  part.height = 3;
  ASSERT_TRUE(WriteImage(folder_ / "part.png", part));
  const auto read = std::get<Image<uint16_t>>(ReadImage(folder_ / "part.png").value());
  ASSERT_EQ(read.width(), 4);
  EXPECT_EQ(read.at(0, 0, 1), picture.at(2, 1, 1));
  EXPECT_EQ(read.at(3, 2, 2), picture.at(5, 3, 2));
}

TEST_F(WriteImageTest, FloatsComeBackBitForBit) {
  Image<float> image(5, 4, 3);
  for (size_t i = 0; i < image.pixels().size(); ++i)
    image.pixels()[i] = static_cast<float>(std::ldexp(RandomUnit(4, 0, i) - 0.25, i % 40));
  image.at(0, 0) = std::numeric_limits<float>::infinity();
  for (const char* name : {"a.exr", "a.tif"}) {
    ASSERT_TRUE(WriteImage(folder_ / name, image.view(), {"R", "G", "B"}, PixelType::kFloat));
    ExpectSame(ReadImage(folder_ / name), image);
  }
}

TEST_F(WriteImageTest, HalfRoundsToElevenBits) {
  Image<float> image(3, 1, 1);
  image.at(0, 0) = 0.333333333f;
  image.at(1, 0) = 1024.5f;
  image.at(2, 0) = 1e6f;
  ASSERT_TRUE(WriteImage(folder_ / "a.exr", image.view(), {"Y"}, PixelType::kHalf));
  const auto read = std::get<Image<float>>(ReadImage(folder_ / "a.exr").value());
  EXPECT_EQ(read.at(0, 0), 1365.0f / 4096);
  EXPECT_EQ(read.at(1, 0), 1024);  // half way between two half floats: rounded to even
  EXPECT_TRUE(std::isinf(read.at(2, 0)));
}

TEST_F(WriteImageTest, IntegerTypesAreClippedAndRounded) {
  Image<float> image(6, 1, 1);
  const float values[] = {-1, 0.4f / 255, 0.6f / 255, 0.5f, 7, NAN};
  std::copy(std::begin(values), std::end(values), image.pixels().begin());
  ASSERT_TRUE(WriteImage(folder_ / "a.png", image.view(), {"Y"}, PixelType::kUint8));
  EXPECT_EQ(std::get<Image<uint8_t>>(*ReadImage(folder_ / "a.png")).pixels(),
            (LargeVector<uint8_t>{0, 0, 1, 128, 255, 0}));
  ASSERT_TRUE(WriteImage(folder_ / "b.png", image.view(), {"Y"}, PixelType::kUint16));
  EXPECT_EQ(std::get<Image<uint16_t>>(*ReadImage(folder_ / "b.png")).pixels(),
            (LargeVector<uint16_t>{0, 103, 154, 32768, 65535, 0}));
}

TEST_F(WriteImageTest, JpegKeepsColoursClosely) {
  Image<uint8_t> image(32, 24, 3);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<uint8_t>(8 * x * (c + 1) / 3 + y);
  ASSERT_TRUE(WriteImage(folder_ / "a.jpg", image.view()));
  const auto read = std::get<Image<uint8_t>>(ReadImage(folder_ / "a.jpg").value());
  for (size_t i = 0; i < image.pixels().size(); ++i)
    ASSERT_NEAR(read.pixels()[i], image.pixels()[i], 6);
}

TEST_F(WriteImageTest, ExrChannelsHaveTypesOfTheirOwnAndColoursComeFirst) {
  const auto counts = NoiseImage<uint32_t>(6, 5, 2);
  Image<float> rgb(6, 5, 3);
  for (size_t i = 0; i < rgb.pixels().size(); ++i) rgb.pixels()[i] = 0.25f * static_cast<float>(i);
  Image<uint32_t> small_counts = counts;
  for (uint32_t& count : small_counts.pixels()) count >>= 8;  // exact as float
  const std::vector<ExrChannel> channels = {
      {"count.G", small_counts.view(), 1}, {"B", rgb.view(), 2}, {"R", rgb.view(), 0, false},
      {"count.R", small_counts.view(), 0}, {"G", rgb.view(), 1},
  };
  ASSERT_TRUE(WriteExr(folder_ / "a.exr", channels));
  const ImageFileInfo info = ReadImageInfo(folder_ / "a.exr").value();
  ASSERT_EQ(info.channels, 5);
  EXPECT_TRUE(info.is_float);
  EXPECT_EQ(std::vector(info.channel_names.begin(), info.channel_names.begin() + 3),
            (std::vector<std::string>{"R", "G", "B"}));
  const auto read = std::get<Image<float>>(ReadImage(folder_ / "a.exr").value());
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x) {
      for (int c = 0; c < 3; ++c) ASSERT_EQ(read.at(x, y, c), rgb.at(x, y, c));
      for (int c = 3; c < 5; ++c) {
        const int count_channel = info.channel_names[c] == "count.R" ? 0 : 1;
        ASSERT_EQ(read.at(x, y, c), static_cast<float>(small_counts.at(x, y, count_channel)));
      }
    }
}

TEST_F(WriteImageTest, MetadataIsInTheFile) {
  Image<float> image(2, 2, 3);
  const ImageMetadata metadata = {{"lf.frame", 12}, {"lf.time_s", 0.25}, {"lf.path", "orbit.yaml"}};
  ASSERT_TRUE(
      WriteImage(folder_ / "a.exr", image.view(), {"R", "G", "B"}, PixelType::kHalf, metadata));
  EXPECT_TRUE(FileContains("a.exr", std::string("lf.frame\0int\0\4\0\0\0\14", 18)));
  EXPECT_TRUE(FileContains("a.exr", std::string("lf.time_s\0double\0", 17)));
  EXPECT_TRUE(FileContains("a.exr", "orbit.yaml"));
  ASSERT_TRUE(
      WriteImage(folder_ / "a.png", image.view(), {"R", "G", "B"}, PixelType::kUint8, metadata));
  EXPECT_TRUE(FileContains("a.png", std::string("tEXtlf.frame\0", 13) + "12"));
  EXPECT_TRUE(FileContains("a.png", std::string("tEXtlf.time_s\0", 14) + "0.25"));
  for (const char* name : {"a.tif", "a.jpg"}) {
    ASSERT_TRUE(
        WriteImage(folder_ / name, image.view(), {"R", "G", "B"}, PixelType::kUint8, metadata));
    EXPECT_TRUE(FileContains(name, "lf.time_s: 0.25\n")) << name;
  }
}

TEST_F(WriteImageTest, ExrKeepsTheTypesOfStandardAttributes) {
  const Image<float> image(2, 2, 3);
  std::array<float, 16> matrix = {};
  for (size_t i = 0; i < 16; ++i) matrix[i] = static_cast<float>(i);
  const std::array<float, 8> primaries = {0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F, 0.3127F, 0.329F};
  const ImageMetadata metadata = {{"focus", 0.75F},
                                  {"framesPerSecond", FrameRate{29.97}},
                                  {"screenWindowCenter", std::array<float, 2>{0.25F, -0.5F}},
                                  {"chromaticities", primaries},
                                  {"worldToNDC", matrix}};
  ASSERT_TRUE(
      WriteImage(folder_ / "a.exr", image.view(), {"R", "G", "B"}, PixelType::kHalf, metadata));
  const Imf::InputFile file((folder_ / "a.exr").c_str());
  const Imf::Header& header = file.header();
  EXPECT_EQ(Imf::focus(header), 0.75F);
  EXPECT_EQ(Imf::framesPerSecond(header).n, 30000);
  EXPECT_EQ(Imf::framesPerSecond(header).d, 1001U);
  EXPECT_EQ(header.screenWindowCenter(), Imath::V2f(0.25F, -0.5F));
  EXPECT_EQ(Imf::chromaticities(header).green, Imath::V2f(0.3F, 0.6F));
  EXPECT_EQ(Imf::chromaticities(header).white, Imath::V2f(0.3127F, 0.329F));
  EXPECT_EQ(Imf::worldToNDC(header)[3][1], 13);
  ASSERT_TRUE(
      WriteImage(folder_ / "a.png", image.view(), {"R", "G", "B"}, PixelType::kUint8, metadata));
  EXPECT_TRUE(FileContains("a.png", std::string("tEXtfocus\0", 10) + "0.75"));
  EXPECT_TRUE(FileContains("a.png", std::string("tEXtworldToNDC\0", 15) + "0 1 2 3 4 5 "));
}

TEST_F(WriteImageTest, OnlyPicturesForDisplaySayThatTheyAreSrgb) {
  const auto data = NoiseImage<uint8_t>(4, 4, 3);
  ASSERT_TRUE(WriteImage(folder_ / "data.png", data.view()));
  EXPECT_FALSE(FileContains("data.png", "sRGB"));
  EXPECT_FALSE(FileContains("data.png", "gAMA"));
  Image<float> picture(4, 4, 3);
  ASSERT_TRUE(
      WriteImage(folder_ / "picture.png", picture.view(), {"R", "G", "B"}, PixelType::kUint8));
  EXPECT_TRUE(FileContains("picture.png", "sRGB"));
}

TEST_F(WriteImageTest, NoDateMakesTwoFilesDiffer) {
  const auto image = NoiseImage<uint8_t>(4, 4, 3);
  const Image<float> floats(4, 4, 3);
  ASSERT_TRUE(WriteImage(folder_ / "a.exr", floats.view(), {"R", "G", "B"}, PixelType::kHalf));
  for (const char* name : {"a.png", "a.tif", "a.jpg"})
    ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
  const std::regex time_of_day("[0-9]{2}:[0-9]{2}:[0-9]{2}");
  for (const char* name : {"a.exr", "a.png", "a.tif", "a.jpg"}) {
    EXPECT_FALSE(std::regex_search(ReadFile(folder_ / name).value(), time_of_day)) << name;
    EXPECT_FALSE(FileContains(name, "tIME")) << name;
  }
}

TEST_F(WriteImageTest, AFormatThatCannotHoldThePixelsIsRefused) {
  Image<float> image(2, 2, 3);
  const std::vector<std::string> names = {"R", "G", "B"};
  const auto error = [&](const char* name, PixelType type) {
    const Result<void> result = WriteImage(folder_ / name, image.view(), names, type);
    EXPECT_FALSE(result) << name;
    EXPECT_EQ(result.error().kind, ErrorKind::kOutput);
    EXPECT_NE(result.error().message.find(name), std::string::npos);
  };
  error("a.png", PixelType::kHalf);
  error("a.exr", PixelType::kUint8);
  error("a.jpg", PixelType::kUint16);
  error("a.tif", PixelType::kHalf);
  error("a.bmp", PixelType::kUint8);
  error("a", PixelType::kUint8);
  EXPECT_FALSE(WriteImage(folder_ / "a.jpg", NoiseImage<uint8_t>(2, 2, 4).view()));
  EXPECT_FALSE(WriteImage(folder_ / "a.png", NoiseImage<uint8_t>(2, 2, 5).view()));
  EXPECT_FALSE(WriteImage(folder_ / "a.png", Image<uint8_t>(0, 0, 3).view()));
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(WriteImageTest, AMissingFolderIsNamed) {
  const Result<void> result =
      WriteImage(folder_ / "none" / "a.png", NoiseImage<uint8_t>(2, 2, 3).view());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kOutput);
  EXPECT_NE(result.error().message.find("none"), std::string::npos);
}

// A limit on the size of files simulates a full disk.
TEST_F(WriteImageTest, AFullDiskLeavesTheOldFileAlone) {
  for (const char* name : {"a.png", "a.tif", "a.exr"}) {
    Image<float> image(64, 64, 3, 0.5f);
    for (size_t i = 0; i < image.pixels().size(); ++i)
      image.pixels()[i] = static_cast<float>(RandomUnit(1, 1, i));
    const PixelType type = name[2] == 'e' ? PixelType::kHalf : PixelType::kUint8;
    ASSERT_TRUE(WriteImage(folder_ / name, image.view(), {"R", "G", "B"}, type));
    const std::string old = ReadFile(folder_ / name).value();
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit unlimited{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &unlimited), 0);
    const rlimit small{1000, unlimited.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const Result<void> result = WriteImage(folder_ / name, image.view(), {"R", "G", "B"}, type);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &unlimited), 0);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::kOutput);
    EXPECT_EQ(ReadFile(folder_ / name).value(), old);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 3);
}

}  // namespace
}  // namespace lf
