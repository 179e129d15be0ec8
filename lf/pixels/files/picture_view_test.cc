// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/picture_view.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

using PictureViewTest = FolderTest;

TEST(PictureViewName, IsWrittenAndReadAgain) {
  for (const char* const path :
       {"a/m.png#160x120+320+240", "l.png#every-14x14+3+4", "v.npy#view+3+4", "m#1.png#2x1+0+0"}) {
    const std::optional<PictureView> view = PictureViewOf(path);
    ASSERT_TRUE(view) << path;
    EXPECT_EQ(PathOfView(*view), path);
    EXPECT_EQ(view->file.string() + ViewSuffix(path), path);
  }
  for (const char* const path :
       {"m.png", "m.png#", "m.png#1x1", "m.png#1x1+0", "m.png#1x1+0+0x", "m.png#0x1+0+0",
        "#1x1+0+0", "m.png#1x1+-1+0", "v.npy#view+3", "v.npy#view+3+4+5", "v.npy#view+-3+4",
        "m.png#every-1x1+0+0", "m.png#99999999999x1+0+0", "m.png#1x1+0+0/b.png"}) {
    EXPECT_FALSE(PictureViewOf(path)) << path;
    EXPECT_EQ(FileOfImage(path), path);
    EXPECT_EQ(ViewSuffix(path), "");
  }
}

// Returns a part of a view.
ImagePart PartOfView(const std::filesystem::path& path, const PixelRect& rect) {
  ImagePart part;
  const Result<void> read = ReadImagePart(
      path, [&](const ImageFileInfo&) -> Result<PixelRect> { return rect; }, &part);
  EXPECT_TRUE(read) << read.error().message;
  return part;
}

TEST_F(PictureViewTest, HoldsThePixelsOfItsPartOfThePicture) {
  const Image<uint16_t> picture = NoiseImage<uint16_t>(30, 20, 3);
  ASSERT_TRUE(WriteImage(folder_ / "m.png", picture.view()));
  // A copy without compression, which is read from the disk.
  {
    std::ofstream ppm(folder_ / "m.ppm", std::ios::binary);
    ppm << "P6 30 20 65535\n";
    for (const uint16_t value : picture.pixels())
      ppm << static_cast<char>(value >> 8) << static_cast<char>(value & 255);
  }
  for (const std::string file : {"m.png", "m.ppm"}) {
    const auto rectangle = ReadImageWithInfo(folder_ / (file + "#6x5+12+10"));
    ASSERT_TRUE(rectangle) << rectangle.error().message;
    EXPECT_EQ(rectangle->info.width, 6);
    EXPECT_EQ(rectangle->info.height, 5);
    const auto strided = ReadImage(folder_ / (file + "#every-7x4+2+3"));
    ASSERT_TRUE(strided) << strided.error().message;
    const auto& whole = std::get<Image<uint16_t>>(rectangle->image);
    const auto& lenslets = std::get<Image<uint16_t>>(*strided);
    EXPECT_EQ(lenslets.width(), 4);
    EXPECT_EQ(lenslets.height(), 5);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 6; ++x) EXPECT_EQ(whole.at(x, y, c), picture.at(12 + x, 10 + y, c));
      for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 4; ++x)
          EXPECT_EQ(lenslets.at(x, y, c), picture.at(2 + 7 * x, 3 + 4 * y, c));
    }
    const ImagePart part = PartOfView(folder_ / (file + "#every-7x4+2+3"), {1, 2, 3, 9});
    EXPECT_EQ(part.rect, (PixelRect{1, 2, 3, 5}));
    EXPECT_EQ(std::get<Image<uint16_t>>(part.image).at(1, 2, 0), picture.at(16, 19, 0));
  }
}

TEST_F(PictureViewTest, OutsideThePictureIsAnError) {
  ASSERT_TRUE(WriteImage(folder_ / "m.png", NoiseImage<uint8_t>(30, 20, 3).view()));
  for (const char* const view : {"#6x5+25+0", "#6x5+0+16", "#6x5+30+0", "#every-7x4+30+0"}) {
    const auto info = ReadImageInfo((folder_ / "m.png").string() + view);
    ASSERT_FALSE(info) << view;
    EXPECT_EQ(info.error().kind, ErrorKind::kInput);
    EXPECT_NE(info.error().message.find("30 x 20 pixels"), std::string::npos);
    EXPECT_FALSE(ReadImage((folder_ / "m.png").string() + view));
  }
  EXPECT_NE(ReadImage((folder_ / "none.png#2x2+0+0")).error().message.find("none.png"),
            std::string::npos);
}

TEST_F(PictureViewTest, APictureThatWasReplacedIsReadAgain) {
  const Image<uint8_t> first(30, 20, 3, 1), second(30, 21, 3, 2);
  ASSERT_TRUE(WriteImage(folder_ / "m.png", first.view()));
  EXPECT_EQ(std::get<Image<uint8_t>>(*ReadImage(folder_ / "m.png#2x2+0+0")).at(0, 0, 0), 1);
  ASSERT_TRUE(WriteImage(folder_ / "m.png", second.view()));
  EXPECT_EQ(std::get<Image<uint8_t>>(*ReadImage(folder_ / "m.png#2x2+0+0")).at(0, 0, 0), 2);
}

TEST_F(PictureViewTest, APictureIsDecodedOnceUntilItIsForgotten) {
  const std::filesystem::path file = folder_ / "m.png";
  ASSERT_TRUE(WriteImage(file, Image<uint8_t>(30, 20, 3, 1).view()));
  const auto first = [&] { return ReadImage(folder_ / "m.png#2x2+0+0"); };
  ASSERT_TRUE(first());
  // Damages the file so that its size and time stay the same.
  const auto time = std::filesystem::last_write_time(file);
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file));
  std::fstream(file, std::ios::binary | std::ios::in | std::ios::out).seekp(size - 20) << "damage";
  std::filesystem::last_write_time(file, time);
  EXPECT_TRUE(first());
  ForgetSharedPicture();
  EXPECT_FALSE(first());
  EXPECT_FALSE(first()) << "the failure is kept as well";
}

TEST_F(PictureViewTest, ManyThreadsShareThePicture) {
  const Image<uint8_t> picture = NoiseImage<uint8_t>(64, 64, 3);
  ASSERT_TRUE(WriteImage(folder_ / "m.png", picture.view()));
  std::vector<int> wrong(8);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 64; ++i) {
        const auto read = ReadImage((folder_ / "m.png").string() + "#8x8+" +
                                    std::to_string(8 * (i % 8)) + "+" + std::to_string(8 * t));
        if (!read || std::get<Image<uint8_t>>(*read).at(3, 5, 1) !=
                         picture.at(8 * (i % 8) + 3, 8 * t + 5, 1))
          ++wrong[t];
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(8));
}

}  // namespace
}  // namespace lf
