// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <half.h>

#include <cmath>
#include <limits>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

// Writes files by OpenEXR, as other programs may write them.
class ExrFileTest : public FolderTest {
 protected:
  std::string path() const { return (folder_ / "a.exr").string(); }
  Image<float> Read() const {
    Result<StoredImage> read = ReadImage(path());
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::get<Image<float>>(*std::move(read)) : Image<float>();
  }
  std::string Fault() const {
    const auto read = ReadImage(path());
    if (read) return "";
    EXPECT_EQ(read.error().kind, ErrorKind::kInput);
    EXPECT_TRUE(read.error().message.starts_with(path() + ": ")) << read.error().message;
    return read.error().message;
  }
};

Image<float> Picture(int width, int height, int channels) {
  Image<float> image(width, height, channels);
  for (size_t i = 0; i < image.pixels().size(); ++i)
    image.pixels()[i] = static_cast<float>(i) - 7.25f;
  return image;
}

// Returns channels R, G and B whose pixels are those of the picture.
Imf::FrameBuffer BufferOf(const Image<float>& image, const Imath::V2i& origin = {0, 0}) {
  Imf::FrameBuffer buffer;
  const size_t pixel_bytes = sizeof(float) * static_cast<size_t>(image.channels());
  for (int channel = 0; channel < image.channels(); ++channel)
    buffer.insert(std::string(1, "RGB"[channel]),
                  Imf::Slice::Make(Imf::FLOAT, image.pixels().data() + channel, origin,
                                   image.width(), image.height(), pixel_bytes,
                                   pixel_bytes * static_cast<size_t>(image.width())));
  return buffer;
}

void AddRgb(Imf::Header* header, Imf::PixelType type = Imf::FLOAT) {
  for (const char* name : {"R", "G", "B"}) header->channels().insert(name, Imf::Channel(type));
}

TEST_F(ExrFileTest, TilesAndAllExactCompressionsAreRead) {
  const Image<float> image = Picture(40, 30, 3);
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
        Imf::PIZ_COMPRESSION}) {
    Imf::Header header(40, 30);
    header.compression() = compression;
    AddRgb(&header);
    {
      Imf::OutputFile file(path().c_str(), header);
      file.setFrameBuffer(BufferOf(image));
      file.writePixels(30);
    }
    EXPECT_EQ(Read().pixels(), image.pixels()) << compression;
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS}) {
      header.setTileDescription(Imf::TileDescription(16, 16, mode));
      Imf::TiledOutputFile file(path().c_str(), header);
      file.setFrameBuffer(BufferOf(image));
      for (int level = 0; level < file.numLevels(); ++level)
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
    EXPECT_EQ(Read().pixels(), image.pixels()) << compression;
  }
}

TEST_F(ExrFileTest, TheDataWindowIsThePicture) {
  const Image<float> image = Picture(5, 4, 3);
  for (const Imath::V2i& origin : {Imath::V2i(-100, 1000), Imath::V2i(1 << 29, -(1 << 29))}) {
    Imf::Header header(Imath::Box2i({0, 0}, {63, 63}),
                       Imath::Box2i(origin, origin + Imath::V2i(4, 3)));
    AddRgb(&header);
    {
      Imf::OutputFile file(path().c_str(), header);
      file.setFrameBuffer(BufferOf(image, origin));
      file.writePixels(4);
    }
    EXPECT_EQ(Read().pixels(), image.pixels());
  }
}

TEST_F(ExrFileTest, EveryTypeBecomesTheFloatOfItsValue) {
  const float floats[] = {0.1f, -3e30f, std::numeric_limits<float>::infinity()};
  const Imath::half halves[] = {Imath::half(0.1f), Imath::half(65504), Imath::half(-0.0f)};
  const uint32_t integers[] = {0, 70000, 1u << 31};
  Imf::Header header(3, 1);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  header.channels().insert("G", Imf::Channel(Imf::HALF));
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  Imf::FrameBuffer buffer;
  buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, floats, {0, 0}, 3, 1));
  buffer.insert("G", Imf::Slice::Make(Imf::HALF, halves, {0, 0}, 3, 1));
  buffer.insert("id", Imf::Slice::Make(Imf::UINT, integers, {0, 0}, 3, 1));
  {
    Imf::OutputFile file(path().c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(1);
  }
  const ImageFileInfo info = ReadImageInfo(path()).value();
  EXPECT_EQ(info.channel_names, (std::vector<std::string>{"R", "G", "id"}));
  const Image<float> image = Read();
  for (int x = 0; x < 3; ++x) {
    EXPECT_EQ(image.at(x, 0, 0), floats[x]);
    EXPECT_EQ(image.at(x, 0, 1), static_cast<float>(halves[x]));
    EXPECT_EQ(image.at(x, 0, 2), static_cast<float>(integers[x]));
  }
  EXPECT_TRUE(std::signbit(image.at(2, 0, 1)));
}

TEST_F(ExrFileTest, TheFirstPartIsReadIfTheOthersHoldNoPicture) {
  const Image<float> first = Picture(5, 4, 3), second(7, 2, 1, 0.5f);
  Imf::Header headers[] = {Imf::Header(5, 4), Imf::Header(7, 2)};
  AddRgb(&headers[0]);
  headers[1].channels().insert("Z", Imf::Channel(Imf::FLOAT));
  for (int i = 0; i < 2; ++i) {
    headers[i].setName(i == 0 ? "beauty" : "depth");
    headers[i].setType(Imf::SCANLINEIMAGE);
  }
  {
    Imf::MultiPartOutputFile file(path().c_str(), headers, 2, true);
    Imf::OutputPart beauty(file, 0), depth(file, 1);
    beauty.setFrameBuffer(BufferOf(first));
    beauty.writePixels(4);
    Imf::FrameBuffer buffer;
    buffer.insert("Z",
                  Imf::Slice::Make(Imf::FLOAT, second.pixels().data(), headers[1].dataWindow()));
    depth.setFrameBuffer(buffer);
    depth.writePixels(2);
  }
  EXPECT_EQ(Read().pixels(), first.pixels());
}

TEST_F(ExrFileTest, WhatIsNoPictureOfWholePixelsIsRefused) {
  Imf::Header luminance(4, 4);
  luminance.channels().insert("Y", Imf::Channel(Imf::HALF));
  luminance.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
  { Imf::OutputFile file(path().c_str(), luminance); }
  EXPECT_NE(Fault().find("channel RY has fewer pixels than the picture"), std::string::npos);

  Imf::Header deep(4, 4);
  deep.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  deep.setType(Imf::DEEPSCANLINE);
  deep.compression() = Imf::ZIPS_COMPRESSION;
  { Imf::DeepScanLineOutputFile file(path().c_str(), deep); }
  EXPECT_NE(Fault().find("holds deep data"), std::string::npos);

  Imf::Header huge(1 << 20, 1 << 20);
  AddRgb(&huge);
  huge.setTileDescription(Imf::TileDescription(4096, 4096));
  { Imf::TiledOutputFile file(path().c_str(), huge); }
  EXPECT_NE(Fault().find("1048576 x 1048576 pixels, more than"), std::string::npos);
}

// OpenEXR would allocate as much memory as the length of an attribute states.
TEST_F(ExrFileTest, AttributesBeyondTheFileAreAnError) {
  Imf::Header headers[] = {Imf::Header(5, 4), Imf::Header(7, 2)};
  AddRgb(&headers[0]);
  headers[1].channels().insert("Z", Imf::Channel(Imf::FLOAT));
  for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
  for (const int parts : {1, 2}) {
    headers[parts - 1].setName("last");
    headers[parts - 1].insert("story", Imf::StringAttribute("of a file"));
    if (parts == 2) headers[0].setName("first");
    { Imf::MultiPartOutputFile file(path().c_str(), headers, parts, true); }
    std::string bytes = ReadFile(path()).value();
    const size_t at = bytes.rfind(std::string("story\0string\0", 13));
    ASSERT_NE(at, std::string::npos);
    EXPECT_TRUE(ReadImageInfo(path()));
    bytes[at + 16] = 0x7f;
    ASSERT_TRUE(WriteFileAtomically(path(), bytes));
    EXPECT_NE(Fault().find("truncated or damaged"), std::string::npos) << parts;
    EXPECT_NE(Fault().find("story"), std::string::npos) << Fault();
  }
}

TEST_F(ExrFileTest, RowsThatWereNeverWrittenAreAnError) {
  Imf::Header header(8, 40);
  AddRgb(&header);
  const Image<float> image = Picture(8, 40, 3);
  {
    Imf::OutputFile file(path().c_str(), header);
    file.setFrameBuffer(BufferOf(image));
    file.writePixels(30);
  }
  EXPECT_NE(Fault().find("truncated or damaged"), std::string::npos);
  EXPECT_EQ(Fault().find('\n'), std::string::npos);
}

}  // namespace
}  // namespace lf
