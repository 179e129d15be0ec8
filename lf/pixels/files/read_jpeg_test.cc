// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/read_jpeg.h"

#include <gtest/gtest.h>
#include <jpeglib.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "lf/core/random.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_byte_source.h"

namespace lf {
namespace {

struct JpegKind {
  int channels = 3;
  int h_sampling = 1, v_sampling = 1;  // sampling of the first component; 1: as the others
  bool is_progressive = false;
  int restart_rows = 0;
  bool has_separate_scans = false;  // one scan for each component
};

// Encodes noise on a gradient: neighbours differ, so that a wrong pixel is detected.
std::string JpegOfKind(int width, int height, const JpegKind& kind) {
  std::vector<uint8_t> row(static_cast<size_t>(width) * kind.channels);
  jpeg_compress_struct compress;
  jpeg_error_mgr errors;
  compress.err = jpeg_std_error(&errors);
  jpeg_create_compress(&compress);
  unsigned char* bytes = nullptr;
  unsigned long size_bytes = 0;
  jpeg_mem_dest(&compress, &bytes, &size_bytes);
  compress.image_width = static_cast<JDIMENSION>(width);
  compress.image_height = static_cast<JDIMENSION>(height);
  compress.input_components = kind.channels;
  compress.in_color_space = kind.channels == 1   ? JCS_GRAYSCALE
                            : kind.channels == 3 ? JCS_RGB
                                                 : JCS_CMYK;
  jpeg_set_defaults(&compress);
  jpeg_set_quality(&compress, 90, TRUE);
  compress.comp_info[0].h_samp_factor = kind.h_sampling;
  compress.comp_info[0].v_samp_factor = kind.v_sampling;
  compress.restart_in_rows = kind.restart_rows;
  if (kind.is_progressive) jpeg_simple_progression(&compress);
  const jpeg_scan_info scans[3] = {
      {1, {0}, 0, 63, 0, 0}, {1, {1}, 0, 63, 0, 0}, {1, {2}, 0, 63, 0, 0}};
  if (kind.has_separate_scans) {
    compress.scan_info = scans;
    compress.num_scans = 3;
  }
  jpeg_start_compress(&compress, TRUE);
  for (int y = 0; y < height; ++y) {
    for (size_t i = 0; i < row.size(); ++i)
      row[i] = static_cast<uint8_t>((i + static_cast<size_t>(y)) / 2 % 128 +
                                    RandomBits(1, static_cast<uint64_t>(y), i) % 128);
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&compress, &pointer, 1);
  }
  jpeg_finish_compress(&compress);
  std::string file(reinterpret_cast<const char*>(bytes), size_bytes);
  jpeg_destroy_compress(&compress);
  std::free(bytes);
  return file;
}

Result<PixelRect> ReadPart(const std::string& file, const PixelRect& wanted,
                           Image<uint8_t>* image) {
  const ByteSource source = SourceOf(file);
  LF_ASSIGN_OR_RETURN(JpegReader reader, JpegReader::Open(source, "a.jpg"));
  return reader.Read(wanted, image);
}

const std::vector<JpegKind> kKinds = {
    {1, 1, 1, false, 0}, {1, 1, 1, true, 0},  {3, 1, 1, false, 0}, {3, 1, 1, true, 0},
    {3, 2, 1, false, 0}, {3, 2, 1, true, 0},  {3, 1, 2, false, 0}, {3, 1, 2, true, 0},
    {3, 2, 2, false, 0}, {3, 2, 2, true, 0},  {3, 4, 1, false, 0}, {3, 4, 2, true, 0},
    {3, 2, 2, false, 1}, {3, 2, 2, false, 3}, {3, 1, 4, false, 0}, {3, 2, 2, false, 0, true}};

// The picture is a wave of 128 grey steps, and noise. The means of squares of the whole picture
// follow the wave, and reduced pixels come near to them.
TEST(ReadJpeg, ReducedPixelsAreAboutMeans) {
  for (const JpegKind& kind : kKinds)
    for (const int reduction : {2, 4, 8}) {
      const std::string file = JpegOfKind(333, 251, kind);
      Image<uint8_t> whole, reduced;
      ASSERT_TRUE(ReadPart(file, {0, 0, 333, 251}, &whole));
      const ByteSource source = SourceOf(file);
      auto reader = JpegReader::Open(source, "a.jpg");
      ASSERT_TRUE(reader && reader->ReadReduced(reduction, &reduced));
      ASSERT_EQ(reduced.width(), (333 + reduction - 1) / reduction);
      ASSERT_EQ(reduced.height(), (251 + reduction - 1) / reduction);
      double error = 0, count = 0;
      for (int y = 0; y < 251 / reduction; ++y)
        for (int x = 0; x < 333 / reduction; ++x, ++count) {
          double mean = 0;
          for (int i = 0; i < reduction * reduction; ++i)
            mean += whole.at(x * reduction + i % reduction, y * reduction + i / reduction);
          error += std::abs(reduced.at(x, y) - mean / (reduction * reduction));
        }
      EXPECT_LT(error / count, reduction == 2 ? 9 : reduction == 4 ? 7 : 4) << reduction;
    }
}

TEST(ReadJpeg, APartIsBitForBitThatOfTheWhole) {
  uint64_t draw = 0;
  for (const JpegKind& kind : kKinds)
    for (const auto& [width, height] : {std::pair(333, 251), std::pair(512, 384)}) {
      const std::string file = JpegOfKind(width, height, kind);
      Image<uint8_t> whole, part;
      const PixelRect all = {0, 0, width, height};
      ASSERT_EQ(*ReadPart(file, all, &whole), all);
      int smaller_count = 0;
      for (int i = 0; i < 16; ++i) {
        PixelRect wanted;
        wanted.x_begin = static_cast<int>(RandomBits(5, 0, draw) % width);
        wanted.y_begin = static_cast<int>(RandomBits(5, 1, draw) % height);
        wanted.x_end =
            std::min(width, wanted.x_begin + 1 + static_cast<int>(RandomBits(5, 2, draw) % 200));
        wanted.y_end =
            std::min(height, wanted.y_begin + 1 + static_cast<int>(RandomBits(5, 3, draw) % 200));
        ++draw;
        const PixelRect rect = *ReadPart(file, wanted, &part);
        ASSERT_EQ(Intersection(rect, wanted), wanted);
        ASSERT_EQ(part.width(), rect.width());
        ASSERT_EQ(part.height(), rect.height());
        smaller_count += rect.pixel_count() < all.pixel_count();
        bool is_same = true;
        for (int y = wanted.y_begin; y < wanted.y_end; ++y)
          for (int x = wanted.x_begin; x < wanted.x_end; ++x)
            for (int c = 0; c < kind.channels; ++c)
              is_same =
                  is_same && part.at(x - rect.x_begin, y - rect.y_begin, c) == whole.at(x, y, c);
        EXPECT_TRUE(is_same) << kind.channels << " " << kind.h_sampling << "x" << kind.v_sampling
                             << (kind.is_progressive ? " progressive " : " ") << wanted.x_begin
                             << " " << wanted.y_begin << " " << wanted.x_end << " " << wanted.y_end;
      }
      EXPECT_GT(smaller_count, 8);
    }
}

TEST(ReadJpeg, DamageIsFoundWhateverIsWanted) {
  for (const JpegKind& kind : kKinds) {
    const std::string file = JpegOfKind(400, 300, kind);
    Image<uint8_t> image;
    for (const double share : {0.3, 0.7, 0.95}) {
      const std::string truncated =
          file.substr(0, static_cast<size_t>(share * static_cast<double>(file.size())));
      for (const PixelRect& wanted :
           {PixelRect{0, 0, 8, 8}, PixelRect{300, 200, 310, 210}, PixelRect{0, 0, 400, 300}}) {
        const Result<PixelRect> read = ReadPart(truncated, wanted, &image);
        ASSERT_FALSE(read) << share << " " << kind.h_sampling << kind.v_sampling;
        EXPECT_EQ(read.error().kind, ErrorKind::kInput);
        EXPECT_EQ(read.error().message.find("a.jpg: truncated or damaged: "), 0u);
      }
    }
  }
}

TEST(ReadJpeg, CmykIsRefused) {
  const std::string file = JpegOfKind(16, 16, {4, 1, 1, false, 0});
  const ByteSource source = SourceOf(file);
  const auto reader = JpegReader::Open(source, "a.jpg");
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().message,
            "a.jpg: is a JPEG of 4 components (CMYK): expected 1 or 3; convert it to colour (RGB) "
            "or grey");
}

TEST(ReadJpeg, StuffingBetweenSegmentsIsHarmless) {
  std::string file = JpegOfKind(16, 16, {});
  Image<uint8_t> expected, image;
  ASSERT_TRUE(ReadPart(file, {0, 0, 16, 16}, &expected));
  file.insert(2, std::string(5, '\0'));
  const Result<PixelRect> read = ReadPart(file, {0, 0, 16, 16}, &image);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(image.pixels(), expected.pixels());
}

// Each scan makes the decoder process the whole picture once more.
TEST(ReadJpeg, CountlessScansAreRefused) {
  const std::string file = JpegOfKind(16, 16, {3, 1, 1, false, 0, true});
  const size_t scan = file.rfind("\xff\xda"), end = file.size() - 2;
  std::string bomb = file.substr(0, end);
  for (int i = 0; i < JpegReader::kMaxScans; ++i) bomb += file.substr(scan, end - scan);
  bomb += file.substr(end);
  Image<uint8_t> image;
  EXPECT_TRUE(ReadPart(file, {0, 0, 16, 16}, &image));
  const Result<PixelRect> read = ReadPart(bomb, {0, 0, 16, 16}, &image);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "a.jpg: truncated or damaged: more than 200 scans");
}

TEST(ReadJpeg, TheOrientationIsThatOfExif) {
  const std::string file = JpegOfKind(24, 16, {});
  // One tag: orientation (0x112), one short of value 6; big-endian and little-endian.
  const std::string big("Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0",
                        32);
  const std::string little(
      "Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0", 32);
  for (const std::string& exif : {big, little, big.substr(0, 20)}) {
    const std::string header = {'\xff', '\xe1', 0, static_cast<char>(exif.size() + 2)};
    const std::string tagged = file.substr(0, 2) + header + exif + file.substr(2);
    const ImageFileInfo info = ReadImageInfoBytes(tagged, "a.jpg").value();
    EXPECT_EQ(info.orientation, exif.size() == 32 ? 6 : 1);
    EXPECT_EQ(info.width, 24);
  }
}

}  // namespace
}  // namespace lf
