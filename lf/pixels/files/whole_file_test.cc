// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/whole_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <span>
#include <string>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_encoder.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class WholeFileTest : public FolderTest {
 protected:
  // Returns the bytes of a file with a picture of several blocks of rows.
  std::string Written(const std::string& name) {
    const auto path = folder_ / name;
    if (path.extension() == ".exr") {
      Image<float> floats(23, 100, 3);
      for (float& value : floats.pixels()) value = 0.5F;
      EXPECT_TRUE(WriteImage(path, floats.view(), {"R", "G", "B"}, PixelType::kHalf));
    } else {
      EXPECT_TRUE(WriteImage(path, NoiseImage<uint8_t>(23, 100, 3).view()));
    }
    return ReadFile(path).value();
  }

  Result<void> Check(const std::string& name, const std::string& bytes) {
    EXPECT_TRUE(WriteFileAtomically(folder_ / name, bytes));
    return CheckFileIsWhole(folder_ / name);
  }
};

TEST_F(WholeFileTest, WhatIsWrittenIsWhole) {
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif"}) {
    const Result<void> whole = Check(name, Written(name));
    EXPECT_TRUE(whole) << whole.error().message;
  }
}

TEST_F(WholeFileTest, AnExrOfSingleRowsIsWhole) {
  Image<float> floats(23, 100, 1, 0.5F);
  const ExrChannel channel = {"R", floats.view()};
  const auto path = folder_ / "rows.exr";
  ASSERT_TRUE(WriteExr(path, std::span(&channel, 1), {}, {}, ExrCompression::kZips));
  EXPECT_TRUE(CheckFileIsWhole(path));
  const std::string bytes = ReadFile(path).value();
  EXPECT_NE(bytes.find(std::string("compression\0compression\0\1\0\0\0\2", 29)), std::string::npos);
  const Result<void> cut = Check("rows.exr", bytes.substr(0, bytes.size() - 1));
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().message.find("of 100"), std::string::npos) << cut.error().message;
  EXPECT_EQ(ParseExrCompression("zips"), ExrCompression::kZips);
  EXPECT_STREQ(NameOf(ExrCompression::kZip), "zip");
  EXPECT_EQ(ParseExrCompression("piz"), std::nullopt);
}

// BigTIFF is what pictures of more than 4000 MiB become.
TEST_F(WholeFileTest, ABigTiffIsWhole) {
  const auto pixels = NoiseImage<uint8_t>(23, 100, 3);
  PictureRows picture;
  picture.width = pixels.width();
  picture.height = pixels.height();
  picture.channels = pixels.channels();
  picture.pack_row = [&](int y, std::byte* to) { std::memcpy(to, pixels.row(y), size_t{23} * 3); };
  const std::string bytes = EncodeTiff(picture, /*largest_classic_bytes=*/0).value();
  EXPECT_EQ(bytes.substr(0, 4), std::string("II+\0", 4));
  const Result<void> whole = Check("a.tif", bytes);
  EXPECT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(std::get<Image<uint8_t>>(ReadImage(folder_ / "a.tif").value()).pixels(),
            pixels.pixels());
  EXPECT_FALSE(Check("a.tif", bytes.substr(0, 2000)));
}

TEST_F(WholeFileTest, NoBeginningOfAFileIsWhole) {
  for (const char* name : {"a.exr", "a.png", "a.jpg"}) {
    const std::string bytes = Written(name);
    for (size_t size = 0; size < bytes.size(); size += size + 40 < bytes.size() ? 7 : 1) {
      const Result<void> whole = Check(name, bytes.substr(0, size));
      ASSERT_FALSE(whole) << name << " " << size;
      EXPECT_NE(whole.error().message.find(name), std::string::npos);
    }
  }
}

// The picture has blocks of 16 rows: a table of 7 offsets precedes the first block, which begins
// with row 0.
TEST_F(WholeFileTest, AnExrWithoutOneOfItsBlocksIsNotWhole) {
  const std::string bytes = Written("a.exr");
  constexpr size_t kBlocks = 7;
  size_t table = 0;
  for (size_t at = 0; at + 8 * kBlocks < bytes.size() && table == 0; ++at) {
    uint64_t offset = 0;
    std::memcpy(&offset, bytes.data() + at, sizeof offset);
    if (offset == at + 8 * kBlocks) table = at;
  }
  ASSERT_GT(table, 0u);
  for (size_t block = 0; block < kBlocks; ++block)
    for (const uint64_t wrong : {uint64_t{0}, uint64_t{bytes.size()}, UINT64_MAX}) {
      std::string cut = bytes;
      std::memcpy(cut.data() + table + 8 * block, &wrong, sizeof wrong);
      const Result<void> whole = Check("a.exr", cut);
      ASSERT_FALSE(whole) << block;
      EXPECT_NE(whole.error().message.find("block " + std::to_string(block + 1) + " of 7"),
                std::string::npos)
          << whole.error().message;
    }
}

TEST_F(WholeFileTest, OtherFilesAreErrors) {
  for (const std::string& bytes :
       {std::string(), std::string("text"), std::string("\x76\x2f\x31\x01", 4),
        std::string("\x76\x2f\x31\x01\x02\x02\0\0", 8),
        std::string("\x76\x2f\x31\x01\x02\0\0\0\0", 9)})
    EXPECT_FALSE(Check("a.exr", bytes));
  EXPECT_FALSE(CheckFileIsWhole(folder_ / "none.exr"));
}

}  // namespace
}  // namespace lf
