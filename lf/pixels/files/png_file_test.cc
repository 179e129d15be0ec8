// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>

#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/image_probe.h"
#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/picture_encoder.h"
#include "lf/pixels/files/test_folder.h"
#include "lf/pixels/files/write_png.h"

namespace lf {
namespace {
using namespace std::string_literals;

FileBytes PngFile(const std::string& bytes) { return FileInMemory(bytes, "a.png"); }

Result<ImageFileInfo> InfoOf(const std::string& bytes) {
  const FileBytes file = PngFile(bytes);
  LF_ASSIGN_OR_RETURN(const auto decoder, OpenPng(file));
  return decoder->info();
}

Result<StoredImage> DecodedPng(const std::string& bytes) {
  const FileBytes file = PngFile(bytes);
  if (const auto format = ProbeImage(file.read, file.name); !format) return format.error();
  LF_ASSIGN_OR_RETURN(const auto decoder, OpenPng(file));
  Result<StoredImage> image = StoredImage();
  LF_RETURN_IF_ERROR(decoder->Read(&image.value()));
  return image;
}

LargeVector<uint8_t> DecodedBytes(const std::string& bytes) {
  const auto image = DecodedPng(bytes);
  EXPECT_TRUE(image) << image.error().message;
  return image ? std::get<Image<uint8_t>>(*image).pixels() : LargeVector<uint8_t>();
}

void ExpectDamaged(const std::string& bytes, const std::string& reason) {
  const auto image = DecodedPng(bytes);
  ASSERT_FALSE(image) << reason;
  EXPECT_EQ(image.error().kind, ErrorKind::kInput);
  EXPECT_EQ(image.error().message.find("a.png: "), 0u) << image.error().message;
  EXPECT_NE(image.error().message.find(reason), std::string::npos) << image.error().message;
  EXPECT_EQ(image.error().message.find('\n'), std::string::npos) << image.error().message;
}

template <class T>
PictureRows PngRows(const Image<T>& image) {
  const auto pack = [&image](int y, std::byte* to) {
    std::memcpy(to, image.row(y), image.size_bytes() / static_cast<size_t>(image.height()));
  };
  PictureRows rows;
  rows.name = "a.png";
  rows.width = image.width();
  rows.height = image.height();
  rows.channels = image.channels();
  rows.type = sizeof(T) == 1 ? PixelType::kUint8 : PixelType::kUint16;
  rows.pack_row = pack;
  return rows;
}

std::string BigEndian(size_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

// Returns a chunk of a PNG file. `damage` is added to its checksum.
std::string Chunk(const std::string& type, const std::string& content, unsigned damage = 0) {
  const std::string checked = type + content;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return BigEndian(content.size()) + checked + BigEndian((sum + damage) & 0xffffffff);
}

std::string Deflated(const std::string& bytes) {
  std::string deflated(compressBound(bytes.size()), '\0');
  uLongf size = deflated.size();
  compress(reinterpret_cast<Bytef*>(deflated.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return deflated.substr(0, size);
}

// A file as another program may write it. `rows` begin with the byte of their filter.
struct Png {
  size_t width = 1, height = 1;
  char depth = 8, colour_type = 0;
  std::string rows;
  std::string before_pixels = {};  // chunks
  std::string behind_pixels = {};
  std::string compressed = Deflated(rows);
  std::string end = Chunk("IEND", "");

  std::string Bytes() const {
    return "\x89PNG\r\n\x1a\n" +
           Chunk("IHDR", BigEndian(width) + BigEndian(height) + depth + colour_type + "\0\0\0"s) +
           before_pixels + Chunk("IDAT", compressed) + behind_pixels + end;
  }
};

// Returns an interlaced file, which libpng writes.
template <class T>
std::string Interlaced(const Image<T>& image, int colour_type) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp of, png_bytep from, size_t count) {
        static_cast<std::string*>(png_get_io_ptr(of))
            ->append(reinterpret_cast<const char*>(from), count);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, image.width(), image.height(), 8 * sizeof(T), colour_type,
               PNG_INTERLACE_ADAM7, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_swap(png);
  for (int passes = png_set_interlace_handling(png); passes > 0; --passes)
    for (int y = 0; y < image.height(); ++y)
      png_write_row(png, reinterpret_cast<png_const_bytep>(image.row(y)));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

template <class T>
void ExpectPngRoundTrip(int width, int height) {
  for (int channels = 1; channels <= 4; ++channels) {
    const auto image = NoiseImage<T>(width, height, channels);
    const auto file = EncodePng(PngRows(image));
    ASSERT_TRUE(file) << file.error().message;
    const auto read = DecodedPng(*file);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_TRUE(std::holds_alternative<Image<T>>(*read));
    EXPECT_EQ(std::get<Image<T>>(*read).channels(), channels);
    EXPECT_EQ(std::get<Image<T>>(*read).pixels(), image.pixels());
  }
}

TEST(PngFile, IntegersComeBackBitForBit) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(13, 70), std::pair(200, 3)}) {
    ExpectPngRoundTrip<uint8_t>(width, height);
    ExpectPngRoundTrip<uint16_t>(width, height);
  }
}

TEST(PngFile, InterlacedFilesAreRead) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 2), std::pair(37, 21)}) {
    const auto bytes = NoiseImage<uint8_t>(width, height, 4);
    EXPECT_EQ(DecodedBytes(Interlaced(bytes, PNG_COLOR_TYPE_RGB_ALPHA)), bytes.pixels());
    const auto words = NoiseImage<uint16_t>(width, height, 3);
    const auto read = DecodedPng(Interlaced(words, PNG_COLOR_TYPE_RGB));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(std::get<Image<uint16_t>>(*read).pixels(), words.pixels());
  }
}

TEST(PngFile, FewBitsBecomeTheFullRange) {
  EXPECT_EQ(DecodedBytes(Png{3, 1, 1, 0, "\0\xa0"s}.Bytes()), (LargeVector<uint8_t>{255, 0, 255}));
  EXPECT_EQ(DecodedBytes(Png{4, 1, 2, 0, "\0\x1b"s}.Bytes()),
            (LargeVector<uint8_t>{0, 85, 170, 255}));
  EXPECT_EQ(DecodedBytes(Png{3, 1, 4, 0, "\0\x1b\xf0"s}.Bytes()),
            (LargeVector<uint8_t>{17, 187, 255}));
}

const std::string kPalette = Chunk("PLTE", "abcdef");

TEST(PngFile, PalettesBecomeColours) {
  EXPECT_EQ(DecodedBytes(Png{3, 1, 1, 3, "\0\x40"s, kPalette}.Bytes()),
            (LargeVector<uint8_t>{'a', 'b', 'c', 'd', 'e', 'f', 'a', 'b', 'c'}));
  const Png with_alpha{2, 2, 8, 3, "\0\0\1\0\1\0"s, kPalette + Chunk("tRNS", "\x9")};
  EXPECT_EQ(DecodedBytes(with_alpha.Bytes()),
            (LargeVector<uint8_t>{'a', 'b', 'c', 9, 'd', 'e', 'f', 255,  //
                                  'd', 'e', 'f', 255, 'a', 'b', 'c', 9}));
  EXPECT_EQ(InfoOf(with_alpha.Bytes()).value().channel_names,
            (std::vector<std::string>{"R", "G", "B", "A"}));
}

TEST(PngFile, AColourThatThePaletteLacksIsNotGuessed) {
  const Png png{2, 2, 8, 3, "\0\0\1\0\1\2"s, kPalette};
  ExpectDamaged(png.Bytes(), "row 1 uses colour 2 of the palette, which has only 2");
}

TEST(PngFile, TheTransparentColourBecomesAlpha) {
  EXPECT_EQ(DecodedBytes(Png{3, 1, 8, 0, "\0\5\6\7"s, Chunk("tRNS", "\0\6"s)}.Bytes()),
            (LargeVector<uint8_t>{5, 255, 6, 0, 7, 255}));
  const Png rgb{1, 1, 16, 2, "\0\1\2\3\4\5\6"s, Chunk("tRNS", "\1\2\3\4\5\6")};
  EXPECT_EQ(std::get<Image<uint16_t>>(DecodedPng(rgb.Bytes()).value()).pixels(),
            (LargeVector<uint16_t>{0x102, 0x304, 0x506, 0}));
}

TEST(PngFile, AlphaAndGammaDoNotTouchTheColours) {
  const Png png{2, 1, 8, 6, "\0abc\0def\x7f"s, Chunk("gAMA", BigEndian(100000))};
  EXPECT_EQ(DecodedBytes(png.Bytes()),
            (LargeVector<uint8_t>{'a', 'b', 'c', 0, 'd', 'e', 'f', 127}));
}

TEST(PngFile, TheHeaderTellsChannelsAndBits) {
  const char* const kNames[] = {"Y", "YA", "RGB", "RGBA"};
  for (int channels = 1; channels <= 4; ++channels) {
    const auto info = InfoOf(EncodePng(PngRows(NoiseImage<uint16_t>(5, 3, channels))).value());
    ASSERT_TRUE(info);
    EXPECT_EQ(std::tuple(info->width, info->height, info->channels, info->bits, info->is_float),
              std::tuple(5, 3, channels, 16, false));
    std::string names;
    for (const std::string& name : info->channel_names) names += name;
    EXPECT_EQ(names, kNames[channels - 1]);
    EXPECT_EQ(info->orientation, 1);
  }
}

TEST(PngFile, ExifDataTellTheOrientation) {
  const std::string tiff = "II*\0\10\0\0\0\1\0\x12\1\3\0\1\0\0\0\6\0\0\0\0\0\0\0"s;
  EXPECT_EQ(InfoOf(Png{1, 1, 8, 0, "\0a"s, Chunk("eXIf", tiff)}.Bytes()).value().orientation, 6);
  std::string profile = "\nexif\n      32\n";
  for (const char byte : "Exif\0\0"s + tiff) {
    const int value = static_cast<uint8_t>(byte);
    profile += {"0123456789abcdef"[value / 16], "0123456789abcdef"[value % 16]};
    if (profile.size() == 50) profile += '\n';
  }
  const std::string key = "Raw profile type exif\0"s;
  for (const std::string& chunk :
       {Chunk("tEXt", key + profile), Chunk("zTXt", key + '\0' + Deflated(profile))})
    EXPECT_EQ(InfoOf(Png{1, 1, 8, 0, "\0a"s, chunk}.Bytes()).value().orientation, 6);
  for (const char* const text : {"", "\n\n", "\nexif\n4\n", "\nexif\n4\n4", "\nexif\n4\n4578"})
    EXPECT_EQ(InfoOf(Png{1, 1, 8, 0, "\0a"s, Chunk("tEXt", key + text)}.Bytes())->orientation, 1);
}

TEST(PngFile, AFileCutAnywhereIsAnError) {
  const auto words = NoiseImage<uint16_t>(16, 12, 3);
  const Png palette{2, 1, 8, 3, "\0\0\1"s, kPalette + Chunk("tRNS", "\x9")};
  for (const std::string& whole : {EncodePng(PngRows(words)).value(),
                                   Interlaced(words, PNG_COLOR_TYPE_RGB), palette.Bytes()}) {
    ASSERT_TRUE(DecodedPng(whole));
    for (size_t size = 0; size < whole.size(); ++size) ExpectDamaged(whole.substr(0, size), "");
  }
}

TEST(PngFile, ADamagedByteAnywhereIsAnError) {
  const auto words = NoiseImage<uint16_t>(8, 6, 3);
  const Png palette{2, 1, 8, 3, "\0\0\1"s, kPalette + Chunk("tRNS", "\x9")};
  for (const std::string& whole :
       {EncodePng(PngRows(words)).value(), Interlaced(words, PNG_COLOR_TYPE_RGB), palette.Bytes()})
    for (size_t i = 0; i < whole.size(); ++i)
      for (const char bits : {'\x01', '\x20', '\x80', '\xff'}) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ bits);
        ExpectDamaged(damaged, "");
      }
}

TEST(PngFile, DamageThatTouchesPixelsIsAnError) {
  Png png{1, 1, 8, 0, "\0a"s};
  png.before_pixels = Chunk("tRNS", "\0a"s, 1);
  ExpectDamaged(png.Bytes(), "tRNS: CRC error");
  png.before_pixels = Chunk("tRNS", "a");
  ExpectDamaged(png.Bytes(), "tRNS: invalid");
  png.before_pixels = Chunk("ABCD", "a");
  ExpectDamaged(png.Bytes(), "ABCD");
  png.before_pixels = Chunk("tRNT", "\0a"s, 1);
  ExpectDamaged(png.Bytes(), "tRNT: CRC error");
  png.before_pixels = "";
  png.compressed.back() ^= 1;
  ExpectDamaged(png.Bytes(), "incorrect data check");
  for (int removed = 0; removed < 8; ++removed) {
    png.compressed.pop_back();
    ExpectDamaged(png.Bytes(), "truncated or damaged");
  }
  Png end{1, 1, 8, 0, "\0a"s};
  end.end = Chunk("IEND", "", 1);
  ExpectDamaged(end.Bytes(), "IEND: CRC error");
}

TEST(PngFile, DamageThatTouchesNoPixelIsIgnored) {
  Png png{1, 1, 8, 0, "\0a"s};
  png.before_pixels = Chunk("tEXt", "Key\0text"s, 1) + Chunk("zTXt", "Key\0\0no zlib"s) +
                      Chunk("iCCP", "no profile") + Chunk("abCd", "unknown") +
                      Chunk("sRGB", "too long") + Chunk("eXIf", "none", 1);
  png.behind_pixels = Chunk("tEXt", "Key\0text"s, 1) + Chunk("tIME", "no time");
  png.compressed += "more";
  testing::internal::CaptureStderr();
  EXPECT_EQ(DecodedBytes(png.Bytes() + "more"), (LargeVector<uint8_t>{'a'}));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(PngFile, TooLargeSizesAreRefusedInTheHeader) {
  for (const size_t width : {size_t{0x7fffffff}, size_t{1} << 20}) {
    const auto info = InfoOf(Png{width, 1 << 20, 8, 6, "\0a"s}.Bytes());
    ASSERT_FALSE(info);
    EXPECT_EQ(info.error().kind, ErrorKind::kInput);
    EXPECT_NE(info.error().message.find("a.png"), std::string::npos);
  }
}

TEST(PngFile, TheHeaderIsReadWithoutThePixels) {
  const std::string bytes = EncodePng(PngRows(NoiseImage<uint8_t>(300, 300, 3))).value();
  FileBytes file = PngFile(bytes);
  uint64_t end = 0;
  file.read = [&, read = file.read](uint64_t offset, std::span<uint8_t> to) {
    end = std::max(end, offset + to.size());
    return read(offset, to);
  };
  ASSERT_TRUE(OpenPng(file));
  EXPECT_LT(end, 200u);
}

TEST(PngFile, ExceptionsOfTheSourcePassThrough) {
  const std::string bytes = EncodePng(PngRows(NoiseImage<uint8_t>(30, 30, 3))).value();
  FileBytes file = PngFile(bytes);
  bool fails = false;
  file.read = [&, read = file.read](uint64_t offset, std::span<uint8_t> to) {
    if (fails) throw std::bad_alloc();
    return read(offset, to);
  };
  const auto decoder = OpenPng(file).value();
  fails = true;
  StoredImage image;
  EXPECT_THROW(static_cast<void>(decoder->Read(&image)), std::bad_alloc);
  EXPECT_THROW(static_cast<void>(OpenPng(file)), std::bad_alloc);
}

TEST(PngFile, ExceptionsOfThePictureAndInterruptionsEndTheEncoding) {
  const auto image = NoiseImage<uint8_t>(30, 100, 3);
  PictureRows picture = PngRows(image);
  int asked = 0;
  picture.is_interrupted = [&] { return ++asked == 3; };
  const auto file = EncodePng(picture);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(asked, 3);
  picture.pack_row = [](int, std::byte*) { throw std::runtime_error("no row"); };
  picture.is_interrupted = {};
  EXPECT_THROW(static_cast<void>(EncodePng(picture)), std::runtime_error);
}

TEST(PngFile, MetadataAreTexts) {
  const auto image = NoiseImage<uint8_t>(2, 2, 3);
  PictureRows picture = PngRows(image);
  picture.metadata = {{"lf.frame", 12}, {"lf.time_s", 0.25}, {std::string(100, 'k'), "long"}};
  const std::string file = EncodePng(picture).value();
  for (const std::string& chunk :
       {Chunk("tEXt", "lf.frame\0"s + "12"), Chunk("tEXt", "lf.time_s\0"s + "0.25"),
        Chunk("tEXt", std::string(79, 'k') + "\0long"s)})
    EXPECT_NE(file.find(chunk), std::string::npos) << chunk;
  EXPECT_EQ(file.find("tIME"), std::string::npos);
  EXPECT_EQ(DecodedBytes(file), image.pixels());
  picture.metadata = {{"", "no key"}};
  const auto refused = EncodePng(picture);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kOutput);
  EXPECT_NE(refused.error().message.find("a.png: cannot be encoded: "), std::string::npos);
}

TEST(PngFile, OnlySrgbPicturesSayThatTheyAreSrgb) {
  const auto image = NoiseImage<uint8_t>(2, 2, 3);
  PictureRows picture = PngRows(image);
  for (const bool is_srgb : {false, true}) {
    picture.is_srgb = is_srgb;
    const std::string file = EncodePng(picture).value();
    EXPECT_EQ(file.find("sRGB") != std::string::npos, is_srgb);
    EXPECT_EQ(file.find("gAMA") != std::string::npos, is_srgb);
    EXPECT_EQ(DecodedBytes(file), image.pixels());
  }
}

TEST(PngFile, ManyThreadsReadAndWriteTheSame) {
  const auto image = NoiseImage<uint16_t>(40, 30, 3);
  const std::string expected = EncodePng(PngRows(image)).value();
  int failures[4] = {};
  std::vector<std::thread> threads;
  for (int& failure : failures)
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i) {
        const auto read = DecodedPng(expected);
        if (!read || std::get<Image<uint16_t>>(*read).pixels() != image.pixels()) ++failure;
        if (DecodedPng(expected.substr(0, 100))) ++failure;
        if (EncodePng(PngRows(image)).value() != expected) ++failure;
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const int failure : failures) EXPECT_EQ(failure, 0);
}

TEST(PngFile, AViewWithAlphaIsWrittenAndReadAgain) {
  Image<uint8_t> image(7, 5, 4);
  for (size_t i = 0; i < image.pixels().size(); ++i)
    image.pixels()[i] = static_cast<uint8_t>(37 * i + 3);
  ImageView<const uint8_t> part = std::as_const(image).view();
  part.data = &image.at(2, 1, 0);
  part.width = 4;
  part.height = 3;
  const auto bytes = EncodePng(part);
  ASSERT_TRUE(bytes);
  const auto read = DecodedPng(*bytes);
  ASSERT_TRUE(read) << read.error().message;
  const auto& again = std::get<Image<uint8_t>>(*read);
  ASSERT_EQ(again.width(), 4);
  ASSERT_EQ(again.height(), 3);
  ASSERT_EQ(again.channels(), 4);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 4; ++c) EXPECT_EQ(again.at(x, y, c), image.at(x + 2, y + 1, c));
}

}  // namespace
}  // namespace lf
