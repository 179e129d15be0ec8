// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/image_probe.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lf {
namespace {
using namespace std::string_literals;

Result<ImageFormat> Probe(const std::string& bytes) {
  const ByteSource source = [&](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (offset >= bytes.size()) return 0;
    const size_t count = std::min<uint64_t>(to.size(), bytes.size() - offset);
    std::copy_n(bytes.data() + offset, count, to.data());
    return count;
  };
  return ProbeImage(source, "a");
}

std::string PngHeader(const std::string& width, const std::string& height) {
  return "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR"s + width + height + "\x10\2\0\0\0csum"s;
}

TEST(ImageProbe, TellsTheFormatByItsFirstBytes) {
  EXPECT_EQ(*Probe(PngHeader("\0\0\0\1"s, "\0\0\0\1"s)), ImageFormat::kPng);
  EXPECT_EQ(*Probe("II*\0\x08\0\0\0\0\0\0\0"s), ImageFormat::kTiff);
  EXPECT_EQ(*Probe("MM\0*\0\0\0\x08\0\0\0\0"s), ImageFormat::kTiff);
  EXPECT_EQ(*Probe("\x76\x2f\x31\x01\x02\0\0\0"s), ImageFormat::kExr);
  EXPECT_EQ(*Probe("P6\n1 1 255\n..."), ImageFormat::kNetpbm);
  EXPECT_EQ(*Probe("PF\n1 1 -1\n..."), ImageFormat::kPfm);
  EXPECT_EQ(*Probe("RIFF....WEBPVP8 "), ImageFormat::kWebp);
  EXPECT_EQ(*Probe("BM....\0\0\0\0"s), ImageFormat::kBmp);
  EXPECT_EQ(*Probe("#?RADIANCE\n"), ImageFormat::kRadiance);
  EXPECT_EQ(*Probe("\xff\x4f\xff\x51"), ImageFormat::kJpeg2000);
  EXPECT_EQ(*Probe("\xff\x0a.."), ImageFormat::kJpegXl);
  EXPECT_EQ(*Probe("\0\0\0\x1c"s + "ftypavif"), ImageFormat::kHeif);
  EXPECT_FALSE(Probe("P6.1"));
  EXPECT_FALSE(Probe("BMP is a text"));
  EXPECT_FALSE(Probe("GIF89a.."));
  EXPECT_FALSE(Probe("II"));
}

std::string MessageOf(const Result<ImageFormat>& result) {
  return result ? "accepted" : result.error().message;
}

TEST(ImageProbe, RefusesMorePixelsThanAreRead) {
  const std::string limit = "more than the limit of 1073741824 pixels in total";
  EXPECT_EQ(MessageOf(Probe(PngHeader("\0\0\x80\0"s, "\0\0\x80\1"s))),
            "a: claims 32768 x 32769 pixels, " + limit);
  EXPECT_EQ(MessageOf(Probe(PngHeader("\xff\xff\xff\xff", "\xff\xff\xff\xff"))),
            "a: claims 4294967295 x 4294967295 pixels, " + limit);
  // A progressive file, with a segment that is skipped and a fill byte before the frame header.
  const auto jpeg = [](const std::string& size) {
    return Probe("\xff\xd8\xff\xe0\0\4zz..\xff\xff\xc2\0\x11\x08"s + size + "\x03");
  };
  EXPECT_EQ(MessageOf(jpeg("\xff\xdc\xff\xdc")), "a: claims 65500 x 65500 pixels, " + limit);
  EXPECT_TRUE(jpeg("\0\x10\0\x10"s));
}

TEST(ImageProbe, RefusesChunksOfAPngThatAreLongerThanTheFile) {
  const std::string head = PngHeader("\0\0\0\1"s, "\0\0\0\1"s);
  const std::string text = "\0\0\0\4tEXta\0bccsum"s, end = "\0\0\0\0IENDcsum"s;
  EXPECT_TRUE(Probe(head + text + end));
  EXPECT_EQ(
      MessageOf(Probe(head + text + "\x7f\xff\xff\xfftEXta\0b"s + end)),
      "a: claims a PNG chunk of 2147483647 bytes, for which the file is too short: truncated or "
      "damaged");
  // A chunk of pixels may claim any length, because it is read in parts. The size of the picture in
  // a truncated file can therefore be read.
  EXPECT_TRUE(Probe(head + "\x7f\xff\xff\xffIDAT..."s));
}

TEST(ImageProbe, RefusesMorePixelsThanTheFileCanHold) {
  const std::string png =  // its pixels have 6 MiB unpacked
      PngHeader("\0\0\4\0"s, "\0\0\4\0"s) + "\0\0\xff\xff"s + "IDAT";
  EXPECT_NE(MessageOf(Probe(png)).find("too short"), std::string::npos);
  EXPECT_NE(MessageOf(Probe(png + std::string(6000, 'x'))).find("too short"), std::string::npos);
  EXPECT_TRUE(Probe(png + std::string(6200, 'x')));
  // The picture has 16384 blocks of 8 x 8 pixels.
  const std::string jpeg = "\xff\xd8\xff\xc0\0\x11\x08\4\0\4\0\x03"s;
  EXPECT_NE(MessageOf(Probe(jpeg + std::string(2000, 'x'))).find("too short"), std::string::npos);
  EXPECT_TRUE(Probe(jpeg + std::string(2048, 'x')));
}

TEST(ImageProbe, ACameraRawFileIsNotTakenForItsThumbnail) {
  const std::string header = "II*\0\x08\0\0\0\2\0"s;
  const std::string width = "\0\1\3\0\1\0\0\0\x40\0\0\0"s;
  const std::string full_size = "\xfe\0\4\0\1\0\0\0\0\0\0\0"s;
  const std::string thumbnail = "\xfe\0\4\0\1\0\0\0\1\0\0\0"s;
  const std::string dng_version = "\x12\xc6\1\0\4\0\0\0\1\4\0\0"s;
  EXPECT_EQ(*Probe(header + full_size + width), ImageFormat::kTiff);
  EXPECT_EQ(*Probe(header + width + thumbnail), ImageFormat::kRaw);
  EXPECT_EQ(*Probe(header + width + dng_version), ImageFormat::kRaw);
  EXPECT_EQ(*Probe("II*\0\x10\0\0\0CR\2\0"s), ImageFormat::kRaw);
  // The file ends within the directory, which the decoder will report.
  EXPECT_EQ(*Probe(header + width), ImageFormat::kTiff);
}

TEST(ImageProbe, FilesOfCamerasAreToldByTheirStart) {
  for (const std::string& start :
       {"FUJIFILMCCD-RAW 0201"s, "FOVb0000"s, "IIRO\x08\0\0\0"s, "IIU\0\x08\0\0\0"s, "\0MRM0000"s,
        "\0\0\0\x18"
        "ftypcrx 0000"s,
        "II\x1a\0\0\0HEAPCCDR"s, "II*\0\x10\0\0\0CR\2\0\0\0\0\0"s}) {
    const auto format = Probe(start);
    ASSERT_TRUE(format) << format.error().message;
    EXPECT_EQ(*format, ImageFormat::kRaw) << start;
  }
}

}  // namespace
}  // namespace lf
