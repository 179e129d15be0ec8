#include "lf/imageio/image_probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace lf {
namespace {
using namespace std::string_literals;

Result<ImageFormat> Probe(const std::string& bytes) {
  const ByteSource source = [&](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (offset >= bytes.size()) return 0;
    const size_t count = std::min<uint64_t>(to.size(), bytes.size() - offset);
    std::memcpy(to.data(), bytes.data() + offset, count);
    return count;
  };
  return ProbeImage(source, "a");
}

std::string PngHeader(const std::string& width, const std::string& height) {
  return "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR"s + width + height;
}

TEST(ImageProbe, TellsTheFormatByItsFirstBytes) {
  EXPECT_EQ(*Probe(PngHeader("\0\0\0\1"s, "\0\0\0\1"s)), ImageFormat::kPng);
  EXPECT_EQ(*Probe("II*\0\x08\0\0\0\0\0\0\0"s), ImageFormat::kTiff);
  EXPECT_EQ(*Probe("MM\0*\0\0\0\x08\0\0\0\0"s), ImageFormat::kTiff);
  EXPECT_EQ(*Probe("\x76\x2f\x31\x01\x02\0\0\0"s), ImageFormat::kExr);
  EXPECT_FALSE(Probe("GIF89a.."));
  EXPECT_FALSE(Probe("II"));
}

TEST(ImageProbe, RefusesMorePixelsThanAreRead) {
  EXPECT_TRUE(Probe(PngHeader("\0\0\x80\0"s, "\0\0\x80\0"s)));  // 2^30
  const auto png = Probe(PngHeader("\0\0\x80\0"s, "\0\0\x80\1"s));
  ASSERT_FALSE(png);
  EXPECT_NE(png.error().message.find("32768 x 32769"), std::string::npos) << png.error().message;
  EXPECT_FALSE(Probe(PngHeader("\xff\xff\xff\xff", "\xff\xff\xff\xff")));
  // Progressive, after a segment to skip and stuffing.
  const auto jpeg = Probe("\xff\xd8\xff\xe0\0\4zz..\xff\xff\xc2\0\x11\x08\xff\xdc\xff\xdc\x03"s);
  ASSERT_FALSE(jpeg);
  EXPECT_NE(jpeg.error().message.find("65500 x 65500"), std::string::npos);
  EXPECT_TRUE(Probe("\xff\xd8\xff\xe0\0\4zz..\xff\xff\xc2\0\x11\x08\0\x10\0\x10\x03"s));
}

TEST(ImageProbe, ACameraRawFileIsNotTakenForItsThumbnail) {
  const std::string header = "II*\0\x08\0\0\0\2\0"s;
  const std::string width = "\0\1\3\0\1\0\0\0\x40\0\0\0"s;
  const std::string full_size = "\xfe\0\4\0\1\0\0\0\0\0\0\0"s;
  const std::string thumbnail = "\xfe\0\4\0\1\0\0\0\1\0\0\0"s;
  const std::string dng_version = "\x12\xc6\1\0\4\0\0\0\1\4\0\0"s;
  EXPECT_TRUE(Probe(header + full_size + width));
  const auto raw = Probe(header + width + thumbnail);
  ASSERT_FALSE(raw);
  EXPECT_NE(raw.error().message.find("camera raw"), std::string::npos);
  EXPECT_FALSE(Probe(header + width + dng_version));
  EXPECT_FALSE(Probe("II*\0\x10\0\0\0CR\2\0"s));
  EXPECT_TRUE(Probe(header + width));  // ends within the directory: the decoder's business
}

}  // namespace
}  // namespace lf
