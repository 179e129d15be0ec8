// SPDX-License-Identifier: Apache-2.0
// Tests OpenTiff() and EncodeTiff(), with files that libtiff writes as other programs do.
#include <gtest/gtest.h>
#include <tiffio.h>

#include <cstring>
#include <limits>
#include <memory>
#include <thread>

#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/libtiff_handle.h"
#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/picture_encoder.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/pixels/files/tiff_samples.h"

namespace lf {
namespace {

FileBytes TiffFile(const std::string& bytes) { return FileInMemory(bytes, "a.tif"); }

Result<ImageWithInfo> DecodedTiff(const std::string& bytes) {
  const FileBytes file = TiffFile(bytes);
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<PictureDecoder> decoder, OpenTiff(file));
  ImageWithInfo result{{}, decoder->info()};
  LF_RETURN_IF_ERROR(decoder->Read(&result.image));
  return result;
}

void ExpectInputError(const std::string& bytes, const std::string& reason) {
  const auto read = DecodedTiff(bytes);
  ASSERT_FALSE(read) << reason;
  EXPECT_EQ(read.error().kind, ErrorKind::kInput);
  EXPECT_TRUE(read.error().message.starts_with("a.tif: ")) << read.error().message;
  EXPECT_NE(read.error().message.find(reason), std::string::npos) << read.error().message;
  EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << read.error().message;
}

// Describes a file as other programs write it. BytesOf() writes it with samples in the order of the
// file: block by block, each filled up to its full size.
struct OtherFile {
  int width = 20, height = 18, samples = 3, bits = 8;
  int format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_RGB, compression = COMPRESSION_NONE;
  int planar = PLANARCONFIG_CONTIG, rows_per_strip = 7, tile = 0;
  std::vector<uint16_t> extras = {};
  int orientation = ORIENTATION_TOPLEFT;
  const char* mode = "wl";
  bool is_directory_first = false;
};

template <class T>
std::string BytesOf(const OtherFile& picture, const std::vector<T>& values) {
  std::string bytes;
  const auto handle = LibtiffHandle::OpenToWrite("other", std::strchr(picture.mode, '8') != nullptr,
                                                 &bytes, std::strchr(picture.mode, 'b') != nullptr);
  TIFF* const tiff = (*handle)->tiff();
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, picture.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, picture.height);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, picture.samples);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, picture.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, picture.format);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, picture.photometric);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, picture.compression);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, picture.planar);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, picture.orientation);
  if (picture.photometric == PHOTOMETRIC_YCBCR)
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  if (!picture.extras.empty())
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, static_cast<int>(picture.extras.size()),
                 picture.extras.data());
  if (picture.photometric == PHOTOMETRIC_PALETTE) {
    std::vector<uint16_t> colours(size_t{1} << picture.bits);
    for (size_t i = 0; i < colours.size(); ++i) colours[i] = static_cast<uint16_t>(257 * i + 256);
    TIFFSetField(tiff, TIFFTAG_COLORMAP, colours.data(), colours.data(), colours.data());
  }
  if (picture.tile > 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, picture.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, picture.tile);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, picture.rows_per_strip);
  }
  // With the directory in front of the pixels, even a truncated file has it.
  if (picture.is_directory_first) TIFFCheckpointDirectory(tiff);
  std::vector<T> copy = values;
  auto* from = reinterpret_cast<std::byte*>(copy.data());
  std::byte* const end = from + copy.size() * sizeof(T);
  const uint32_t blocks = picture.tile > 0 ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
  const tmsize_t block_bytes = picture.tile > 0 ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
  for (uint32_t i = 0; i < blocks; ++i) {
    const tmsize_t size = std::min<tmsize_t>(block_bytes, end - from);
    if (picture.tile > 0)
      TIFFWriteEncodedTile(tiff, i, from, size);
    else
      TIFFWriteEncodedStrip(tiff, i, from, size);
    from += size;
  }
  (*handle)->Close();
  return bytes;
}

template <class T>
LargeVector<T> PixelsOf(const Result<ImageWithInfo>& read) {
  EXPECT_TRUE(read);
  if (!read) return {};
  return std::get<Image<T>>(read->image).pixels();
}

template <class T>
std::vector<T> Noise(int width, int height, int samples) {
  const Image<T> image = NoiseImage<T>(width, height, samples);
  return {image.pixels().begin(), image.pixels().end()};
}

template <class T>
LargeVector<T> LargeVectorOf(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

template <class T>
PictureRows TiffRows(const Image<T>& image, PixelType type) {
  PictureRows rows{"a.tif", image.width(), image.height(), image.channels(), type, false, {}, {},
                   {}};
  rows.pack_row = [&image](int y, std::byte* to) {
    std::memcpy(to, image.row(y), image.view().stride * sizeof(T));
  };
  return rows;
}

template <class T>
void ExpectTiffRoundTrip(int channels, PixelType type) {
  const auto image = NoiseImage<T>(21, 70, channels);
  const std::string bytes = EncodeTiff(TiffRows(image, type)).value();
  EXPECT_EQ(std::memcmp(PixelsOf<T>(DecodedTiff(bytes)).data(), image.pixels().data(),
                        image.size_bytes()),
            0);
  EXPECT_EQ(bytes, EncodeTiff(TiffRows(image, type)).value());
}

TEST(TiffFileTest, WrittenPicturesAreReadAgain) {
  for (int channels = 1; channels <= 6; ++channels) {
    ExpectTiffRoundTrip<uint8_t>(channels, PixelType::kUint8);
    ExpectTiffRoundTrip<uint16_t>(channels, PixelType::kUint16);
    ExpectTiffRoundTrip<float>(channels, PixelType::kFloat);
  }
}

TEST(TiffFileTest, MetadataBecomesTheDescription) {
  const Image<uint8_t> image(4, 4, 3);
  PictureRows rows = TiffRows(image, PixelType::kUint8);
  EXPECT_EQ(EncodeTiff(rows)->find("lf."), std::string::npos);
  rows.metadata = {{"lf.frame", 12}, {"lf.time_s", 0.25}};
  EXPECT_NE(EncodeTiff(rows)->find("lf.frame: 12\nlf.time_s: 0.25\n"), std::string::npos);
}

TEST(TiffFileTest, WritingCanBeInterrupted) {
  const Image<uint8_t> image(4, 100, 3);
  PictureRows rows = TiffRows(image, PixelType::kUint8);
  int calls = 0;
  rows.is_interrupted = [&calls] { return ++calls == 3; };
  EXPECT_EQ(EncodeTiff(rows).error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(calls, 3);
}

TEST(TiffFileTest, EveryKindOfFileIsRead) {
  const auto values = Noise<uint16_t>(20, 18, 3);
  for (const char* mode : {"wl", "wb", "wl8", "wb8"})
    for (const int compression :
         {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_DEFLATE,
          COMPRESSION_PACKBITS, COMPRESSION_ZSTD, COMPRESSION_LZMA}) {
      OtherFile file;
      file.bits = 16;
      file.mode = mode;
      file.compression = compression;
      EXPECT_EQ(PixelsOf<uint16_t>(DecodedTiff(BytesOf(file, values))), LargeVectorOf(values))
          << mode << compression;
    }
}

TEST(TiffFileTest, TilesAndPlanesAreReadInOrder) {
  OtherFile file;
  file.width = file.height = 20;
  file.samples = 2;
  file.photometric = PHOTOMETRIC_MINISBLACK;
  file.tile = 16;
  file.planar = PLANARCONFIG_SEPARATE;
  // The tiles have 16 x 16 pixels: two across, two down, for each of two planes.
  std::vector<uint8_t> values(size_t{8} * 256);
  const auto value = [](int x, int y, int plane) {
    return static_cast<uint8_t>(7 * x + 13 * y + 100 * plane);
  };
  for (int i = 0; i < 8 * 256; ++i) {
    const int tile = i / 256 % 4;
    values[i] = value(tile % 2 * 16 + i % 16, tile / 2 * 16 + i % 256 / 16, i / 1024);
  }
  const auto read = DecodedTiff(BytesOf(file, values));
  ASSERT_TRUE(read) << read.error().message;
  const auto& image = std::get<Image<uint8_t>>(read->image);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x)
      for (int plane = 0; plane < 2; ++plane)
        ASSERT_EQ(image.at(x, y, plane), value(x, y, plane)) << x << " " << y << " " << plane;
}

TEST(TiffFileTest, FewBitsAreScaledToTheFullRange) {
  OtherFile file;
  file.width = 4;
  file.height = 1;
  file.samples = 1;
  file.photometric = PHOTOMETRIC_MINISBLACK;
  file.bits = 2;
  EXPECT_EQ(PixelsOf<uint8_t>(DecodedTiff(BytesOf<uint8_t>(file, {0x1b}))),
            (LargeVector<uint8_t>{0, 85, 170, 255}));
  file.photometric = PHOTOMETRIC_MINISWHITE;
  EXPECT_EQ(PixelsOf<uint8_t>(DecodedTiff(BytesOf<uint8_t>(file, {0x1b}))),
            (LargeVector<uint8_t>{255, 170, 85, 0}));
  file.photometric = PHOTOMETRIC_MINISBLACK;
  file.bits = 12;
  EXPECT_EQ(PixelsOf<uint16_t>(DecodedTiff(BytesOf<uint8_t>(file, {0, 0, 1, 0x80, 0x0f, 0xff}))),
            (LargeVector<uint16_t>{0, 16, 2048 * 65535 / 4095, 65535}));
  file.photometric = PHOTOMETRIC_MINISWHITE;
  EXPECT_EQ(PixelsOf<uint16_t>(DecodedTiff(BytesOf<uint8_t>(file, {0, 0, 1, 0x80, 0x0f, 0xff}))),
            (LargeVector<uint16_t>{65535, 65519, 65535 - 2048 * 65535 / 4095, 0}));
}

TEST(TiffFileTest, PalettesBecomeColours) {
  OtherFile file;
  file.width = 2;
  file.height = 1;
  file.samples = 1;
  file.photometric = PHOTOMETRIC_PALETTE;
  file.bits = 4;
  EXPECT_EQ(PixelsOf<uint8_t>(DecodedTiff(BytesOf<uint8_t>(file, {0x2f}))),
            (LargeVector<uint8_t>{2, 2, 2, 15, 15, 15}));
}

template <class T>
void ExpectFloats(int format, const std::vector<T>& values) {
  OtherFile file;
  file.width = static_cast<int>(values.size());
  file.height = file.samples = 1;
  file.photometric = PHOTOMETRIC_MINISBLACK;
  file.bits = 8 * static_cast<int>(sizeof(T));
  file.format = format;
  for (const char* mode : {"wl", "wb"}) {
    file.mode = mode;
    const auto read = PixelsOf<float>(DecodedTiff(BytesOf(file, values)));
    ASSERT_EQ(read.size(), values.size());
    for (size_t i = 0; i < values.size(); ++i) EXPECT_EQ(read[i], static_cast<float>(values[i]));
  }
}

TEST(TiffFileTest, OtherNumbersBecomeFloatsOfEqualValue) {
  ExpectFloats<uint32_t>(SAMPLEFORMAT_UINT, {0, 1, 70000, 1u << 24, 1u << 31});
  ExpectFloats<uint64_t>(SAMPLEFORMAT_UINT, {0, 1, 70000, uint64_t{1} << 63});
  ExpectFloats<int8_t>(SAMPLEFORMAT_INT, {0, 1, -1, 127, -128});
  ExpectFloats<int16_t>(SAMPLEFORMAT_INT, {0, 1, -1, 32767, -32768});
  ExpectFloats<int32_t>(SAMPLEFORMAT_INT, {0, 1, -1, 1 << 30, -(1 << 30)});
  ExpectFloats<int64_t>(SAMPLEFORMAT_INT, {0, 1, -1, int64_t{1} << 62, -(int64_t{1} << 62)});
  ExpectFloats<float>(SAMPLEFORMAT_IEEEFP, {0, 1, -0.1f, 1e30f});
  ExpectFloats<double>(SAMPLEFORMAT_IEEEFP, {0, 1, -0.1, 1e30});
}

TEST(TiffFileTest, HalvesBecomeFloats) {
  const std::vector<uint16_t> halves = {0x0000, 0x8000, 0x0001, 0x03ff, 0x0400,
                                        0x3c00, 0xc000, 0x7bff, 0x7c00, 0x7e00};
  std::vector<float> floats(halves.size());
  ConvertSamples({TiffSamples::Kind::kFloat, 16}, reinterpret_cast<const std::byte*>(halves.data()),
                 halves.size(), floats.data(), 1);
  const std::vector<float> expected = {0, -0.0f, 0x1p-24f, 0x3ffp-24f, 0x1p-14f, 1, -2, 65504};
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(floats[i], expected[i]);
  EXPECT_TRUE(std::signbit(floats[1]));
  EXPECT_EQ(floats[8], std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(floats[9]));
}

TEST(TiffFileTest, ExtraSamplesDecideWhichChannelIsAlpha) {
  using ChannelNames = std::vector<std::string>;
  const auto names = [](int samples, std::vector<uint16_t> extras) {
    OtherFile file;
    file.samples = samples;
    file.extras = std::move(extras);
    if (samples < 3) file.photometric = PHOTOMETRIC_MINISBLACK;
    const auto read = DecodedTiff(BytesOf(file, Noise<uint8_t>(20, 18, samples)));
    EXPECT_EQ(PixelsOf<uint8_t>(read), NoiseImage<uint8_t>(20, 18, samples).pixels());
    return read->info.channel_names;
  };
  EXPECT_EQ(names(1, {}), (ChannelNames{"Y"}));
  EXPECT_EQ(names(2, {EXTRASAMPLE_UNASSALPHA}), (ChannelNames{"Y", "A"}));
  EXPECT_EQ(names(2, {EXTRASAMPLE_UNSPECIFIED}), (ChannelNames{"R", "G"}));
  EXPECT_EQ(names(3, {}), (ChannelNames{"R", "G", "B"}));
  EXPECT_EQ(names(4, {}), (ChannelNames{"R", "G", "B", "A"}));
  EXPECT_EQ(names(4, {EXTRASAMPLE_ASSOCALPHA}), (ChannelNames{"R", "G", "B", "A"}));
  EXPECT_EQ(names(4, {EXTRASAMPLE_UNSPECIFIED}), (ChannelNames{"R", "G", "B", "channel3"}));
  EXPECT_EQ(names(5, {EXTRASAMPLE_UNSPECIFIED, EXTRASAMPLE_UNASSALPHA}),
            (ChannelNames{"R", "G", "B", "channel3", "A"}));
}

TEST(TiffFileTest, TheOrientationTurnsNothing) {
  OtherFile file;
  const auto values = Noise<uint8_t>(20, 18, 3);
  file.orientation = ORIENTATION_RIGHTTOP;
  const auto read = DecodedTiff(BytesOf(file, values));
  EXPECT_EQ(PixelsOf<uint8_t>(read), LargeVectorOf(values));
  EXPECT_EQ(read->info.orientation, 6);
}

TEST(TiffFileTest, JpegInTiffBecomesRgb) {
  OtherFile file;
  file.width = file.height = file.rows_per_strip = 16;
  file.compression = COMPRESSION_JPEG;
  file.photometric = PHOTOMETRIC_YCBCR;
  std::vector<uint8_t> values;
  for (int i = 0; i < 256; ++i) values.insert(values.end(), {200, 100, 50});
  const auto pixels = PixelsOf<uint8_t>(DecodedTiff(BytesOf(file, values)));
  ASSERT_EQ(pixels.size(), values.size());
  for (size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(pixels[i], values[i], 4);
}

TEST(TiffFileTest, OtherColoursAreNamed) {
  OtherFile file;
  file.samples = 4;
  file.photometric = PHOTOMETRIC_SEPARATED;
  ExpectInputError(BytesOf(file, Noise<uint8_t>(20, 18, 4)), "CMYK");
  file.samples = 3;
  file.photometric = PHOTOMETRIC_CIELAB;
  ExpectInputError(BytesOf(file, Noise<uint8_t>(20, 18, 3)), "L*a*b*");
  file.photometric = PHOTOMETRIC_RGB;
  file.bits = 24;
  ExpectInputError(BytesOf(file, Noise<uint8_t>(20, 18, 9)), "integers of 24 bits");
}

std::vector<std::string> FilesToDamage() {
  std::vector<std::string> files;
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
                                COMPRESSION_PACKBITS, COMPRESSION_JPEG, COMPRESSION_ZSTD})
    for (const bool is_directory_first : {false, true})
      for (const int tile : {0, 16}) {
        OtherFile file;
        file.compression = compression;
        file.rows_per_strip = 8;
        file.tile = tile;
        file.is_directory_first = is_directory_first;
        files.push_back(BytesOf(file, Noise<uint8_t>(32, 32, 3)));
      }
  OtherFile fax;
  fax.samples = fax.bits = 1;
  fax.photometric = PHOTOMETRIC_MINISWHITE;
  fax.compression = COMPRESSION_CCITTFAX4;
  files.push_back(BytesOf(fax, Noise<uint8_t>(20, 18, 1)));
  const auto image = NoiseImage<float>(9, 40, 3);
  PictureRows rows = TiffRows(image, PixelType::kFloat);
  rows.metadata = {{"lf.frame", 12}};
  files.push_back(EncodeTiff(rows).value());
  return files;
}

TEST(TiffFileTest, AFileCutAnywhereIsAnError) {
  for (const std::string& whole : FilesToDamage()) {
    ASSERT_TRUE(DecodedTiff(whole)) << DecodedTiff(whole).error().message;
    for (size_t size = 0; size < whole.size(); ++size) ExpectInputError(whole.substr(0, size), "");
  }
}

TEST(TiffFileTest, DamageIsNoCrash) {
  for (const std::string& whole : FilesToDamage())
    for (uint64_t i = 0; i < 500; ++i) {
      std::string damaged = whole;
      for (uint64_t k = 0; k <= i % 3; ++k)
        damaged[RandomBits(3, i, 2 * k) % damaged.size()] ^=
            static_cast<char>(1 << RandomBits(3, i, 2 * k + 1) % 8);
      const auto read = DecodedTiff(damaged);
      if (read) continue;
      EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    }
}

// Some bits of a deflate stream fill up a byte and mean nothing.
TEST(TiffFileTest, DamageWithinDeflateIsAnErrorIfItMatters) {
  const auto image = NoiseImage<uint8_t>(20, 40, 3);
  const std::string whole = EncodeTiff(TiffRows(image, PixelType::kUint8)).value();
  constexpr size_t kFirstStrip = 8, kStripBytes = 1900;
  for (size_t i = kFirstStrip + 2; i < kStripBytes; ++i) {
    std::string damaged = whole;
    damaged[i] ^= 0x10;
    const auto read = DecodedTiff(damaged);
    if (!read) continue;
    EXPECT_EQ(PixelsOf<uint8_t>(read), image.pixels()) << i;
  }
}

TEST(TiffFileTest, MissingRowsOfAFaxAreAnError) {
  OtherFile file;
  file.samples = file.bits = 1;
  file.rows_per_strip = 100;
  file.photometric = PHOTOMETRIC_MINISWHITE;
  file.compression = COMPRESSION_CCITTFAX4;
  std::string bytes = BytesOf(file, Noise<uint8_t>(3, 18, 1));
  EXPECT_TRUE(DecodedTiff(bytes));
  // The entry of the height: tag 257, 16-bit integer, one value.
  const size_t height = bytes.find(std::string("\x01\x01\x03\0\x01\0\0\0\x12", 9));
  ASSERT_NE(height, std::string::npos);
  bytes[height + 8] = 30;
  ExpectInputError(bytes, "damaged");
}

TEST(TiffFileTest, ClaimsAreCheckedBeforePixelsAreAllocated) {
  OtherFile file;
  std::string bytes = BytesOf(file, Noise<uint8_t>(20, 18, 3));
  // The entry of the width: tag 256, 16-bit integer, one value.
  const size_t width = bytes.find(std::string("\0\x01\x03\0\x01\0\0\0\x14", 9));
  ASSERT_NE(width, std::string::npos);
  bytes[width + 9] = '\xff';
  ExpectInputError(bytes, "beyond the end");
  file.tile = 16;
  bytes = BytesOf(file, Noise<uint8_t>(32, 32, 3));
  const size_t tile = bytes.find(std::string("\x42\x01\x03\0\x01\0\0\0\x10", 9));
  ASSERT_NE(tile, std::string::npos);
  bytes[tile + 9] = bytes[tile + 12 + 9] = '\xff';
  ExpectInputError(bytes, "claims tiles of 65296 x 65296 pixels");
}

TEST(TiffFileTest, ASourceMayThrow) {
  const std::string bytes = BytesOf(OtherFile{}, Noise<uint8_t>(20, 18, 3));
  const FileBytes file{[](uint64_t, std::span<uint8_t>) -> size_t { throw std::bad_alloc(); },
                       bytes.size(), "a.tif"};
  EXPECT_THROW(static_cast<void>(OpenTiff(file)), std::bad_alloc);
}

TEST(TiffFileTest, ManyThreadsReadTheSame) {
  const auto image = NoiseImage<uint16_t>(40, 30, 3);
  const std::string bytes = EncodeTiff(TiffRows(image, PixelType::kUint16)).value();
  int failures[4] = {};
  std::vector<std::thread> threads;
  for (int& failure : failures)
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i) {
        const auto read = DecodedTiff(bytes);
        if (!read || std::get<Image<uint16_t>>(read->image).pixels() != image.pixels()) ++failure;
        if (DecodedTiff(bytes.substr(0, bytes.size() / 2))) ++failure;
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const int failure : failures) EXPECT_EQ(failure, 0);
}

}  // namespace
}  // namespace lf
