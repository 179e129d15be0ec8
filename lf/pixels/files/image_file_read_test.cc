// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
using namespace std::string_literals;

class ReadImageTest : public FolderTest {
 protected:
  void Save(const std::string& name, const std::string& bytes) const {
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, bytes));
  }
  void ExpectInputError(const Error& error, const std::string& name, const std::string& reason) {
    EXPECT_EQ(error.kind, ErrorKind::kInput);
    EXPECT_NE(error.message.find(name), std::string::npos) << error.message;
    EXPECT_NE(error.message.find(reason), std::string::npos) << error.message;
    EXPECT_EQ(error.message.find('\n'), std::string::npos) << error.message;
  }
};

// 16 x 1 grey pixels of 4 bits: 0, 1, ... 15.
const std::string kPng4Bit =
    "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x10\0\0\0\x01\x04\0\0\0\0\x37\xe2\x9c\x82\0\0\0\x11IDAT"
    "\x78\xda\x63\x60\x54\x76\x4d\xef\x5c\x7d\xf6\x3d\0\x0b\x55\x03\xc1\xf3\xa9\xfc\xda\0\0\0\0IEND"
    "\xae\x42\x60\x82"s;
// 2 x 1 pixels with a palette of two colours: (10, 20, 30), (40, 50, 60).
const std::string kPngPalette =
    "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x02\0\0\0\x01\x01\x03\0\0\0\xce\xec\xed\xc9\0\0\0\x06PLT"
    "E"
    "\x0a\x14\x1e\x28\x32\x3c\xd5\x1b\xb4\xe9\0\0\0\x0aIDAT\x78\xda\x63\x70\0\0\0\x42\0\x41\x84\xbf"
    "\x8e\x62\0\0\0\0IEND\xae\x42\x60\x82"s;

TEST_F(ReadImageTest, FewBitsAreScaledToTheFullRange) {
  const auto png = std::get<Image<uint8_t>>(ReadImageBytes(kPng4Bit, "4 bit").value());
  ASSERT_EQ(png.width(), 16);
  for (int x = 0; x < 16; ++x) EXPECT_EQ(png.at(x, 0), 17 * x);
}

TEST_F(ReadImageTest, PalettesBecomeColours) {
  const auto image = std::get<Image<uint8_t>>(ReadImageBytes(kPngPalette, "palette").value());
  EXPECT_EQ(image.channels(), 3);
  EXPECT_EQ(image.pixels(), (LargeVector<uint8_t>{10, 20, 30, 40, 50, 60}));
}

TEST_F(ReadImageTest, AlphaDoesNotTouchTheColours) {
  Image<uint8_t> image(2, 1, 4);
  image.pixels() = {200, 100, 50, 0, 255, 255, 255, 7};
  for (const char* name : {"a.png", "a.tif"}) {
    ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
    EXPECT_EQ(std::get<Image<uint8_t>>(*ReadImage(folder_ / name)).pixels(), image.pixels());
  }
}

TEST_F(ReadImageTest, TheContentDecidesNotTheName) {
  Save("a.jpg", kPng4Bit);
  EXPECT_TRUE(ReadImage(folder_ / "a.jpg"));
  EXPECT_EQ(ReadImageInfo(folder_ / "a.jpg").value().width, 16);
}

TEST_F(ReadImageTest, TheHeaderAloneTellsSizeAndType) {
  ASSERT_TRUE(WriteImage(folder_ / "a.png", NoiseImage<uint16_t>(5, 3, 3).view()));
  ASSERT_TRUE(WriteImage(folder_ / "a.jpg", NoiseImage<uint8_t>(50, 30, 1).view()));
  const ImageFileInfo png = ReadImageInfo(folder_ / "a.png").value();
  EXPECT_EQ(std::tuple(png.width, png.height, png.channels, png.bits, png.is_float),
            std::tuple(5, 3, 3, 16, false));
  const ImageFileInfo jpeg = ReadImageInfo(folder_ / "a.jpg").value();
  EXPECT_EQ(std::tuple(jpeg.width, jpeg.height, jpeg.channels, jpeg.bits, jpeg.is_float),
            std::tuple(50, 30, 1, 8, false));
}

TEST_F(ReadImageTest, AFileCutAnywhereIsAnError) {
  const auto bytes = NoiseImage<uint8_t>(16, 12, 3);
  Image<float> floats(16, 12, 3, 0.5f);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", bytes.view()));
  ASSERT_TRUE(WriteImage(folder_ / "a.jpg", bytes.view()));
  ASSERT_TRUE(WriteImage(folder_ / "a.tif", bytes.view()));
  ASSERT_TRUE(WriteImage(folder_ / "a.exr", floats.view(), {"R", "G", "B"}, PixelType::kHalf));
  for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr"}) {
    const std::string whole = ReadFile(folder_ / name).value();
    ASSERT_TRUE(ReadImageBytes(whole, name));
    for (size_t size = 0; size < whole.size(); ++size) {
      const auto cut = ReadImageBytes(std::string_view(whole).substr(0, size), name);
      ASSERT_FALSE(cut) << name << " cut to " << size << " of " << whole.size();
      ExpectInputError(cut.error(), name, "");
    }
  }
}

TEST_F(ReadImageTest, DamageWithinAPngIsAnError) {
  std::string damaged = kPng4Bit;
  damaged[50] ^= 0x10;
  const auto read = ReadImageBytes(damaged, "damaged.png");
  ASSERT_FALSE(read);
  ExpectInputError(read.error(), "damaged.png", "damaged");
}

TEST_F(ReadImageTest, WhatIsNoImageFileIsNamed) {
  ExpectInputError(ReadImage(folder_ / "none.png").error(), "none.png", "No such file");
  ExpectInputError(ReadImageInfo(folder_ / "none.png").error(), "none.png", "No such file");
  ExpectInputError(ReadImage(folder_).error(), folder_.string(), "is a folder");
  ExpectInputError(ReadImageInfo(folder_).error(), folder_.string(), "is a folder");
  Save("empty.png", "");
  ExpectInputError(ReadImage(folder_ / "empty.png").error(), "empty.png", "empty");
  ExpectInputError(ReadImageInfo(folder_ / "empty.png").error(), "empty.png", "empty");
  Save("text.png", "frames: 60\n");
  ExpectInputError(ReadImage(folder_ / "text.png").error(), "text.png", "is not a PNG, JPEG");
}

TEST_F(ReadImageTest, ManyThreadsReadTheSame) {
  const auto image = NoiseImage<uint16_t>(40, 30, 3);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", image.view()));
  int failures[4] = {};
  std::vector<std::thread> threads;
  for (int& failure : failures)
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i) {
        const auto read = ReadImage(folder_ / "a.png");
        if (!read || std::get<Image<uint16_t>>(*read).pixels() != image.pixels()) ++failure;
        if (ReadImageBytes("\x89PNG\r\n\x1a\n", "cut")) ++failure;
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const int failure : failures) EXPECT_EQ(failure, 0);
}

}  // namespace
}  // namespace lf
