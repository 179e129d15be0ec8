// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/write_jpeg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <variant>

#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_encoder.h"

namespace lf {
namespace {

Image<uint8_t> Gradient(int width, int height, int channels) {
  Image<uint8_t> image(width, height, channels);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y, c) = static_cast<uint8_t>(40 + 2 * x + y + 10 * c);
  return image;
}

void ExpectIsReadAgain(const Result<std::string>& bytes, const Image<uint8_t>& image) {
  ASSERT_TRUE(bytes);
  const auto read = ReadImageBytes(*bytes, "a.jpg");
  ASSERT_TRUE(read) << read.error().message;
  const auto& again = std::get<Image<uint8_t>>(*read);
  ASSERT_EQ(again.width(), image.width());
  ASSERT_EQ(again.height(), image.height());
  ASSERT_EQ(again.channels(), image.channels());
  double sum = 0;
  for (size_t i = 0; i < image.pixels().size(); ++i)
    sum += std::abs(int{image.pixels()[i]} - int{again.pixels()[i]});
  EXPECT_LT(sum / static_cast<double>(image.pixels().size()), 3);
}

PictureRows JpegRows(const Image<uint8_t>& image) {
  PictureRows rows;
  rows.name = "a.jpg";
  rows.width = image.width();
  rows.height = image.height();
  rows.channels = image.channels();
  rows.pack_row = [&image](int y, std::byte* to) {
    std::memcpy(to, image.row(y), static_cast<size_t>(image.width()) * image.channels());
  };
  return rows;
}

TEST(WriteJpeg, IsReadAgain) {
  const Image<uint8_t> image = Gradient(70, 33, 3);
  ExpectIsReadAgain(EncodeJpeg(image.view(), 95), image);
}

TEST(WriteJpeg, APartOfAPictureIsWrittenAlone) {
  const Image<uint8_t> image = Gradient(70, 33, 3);
  ImageView<const uint8_t> part = image.view();
  part.data = &image.at(30, 10);
  part.width = 20;
  part.height = 12;
  Image<uint8_t> expected(20, 12, 3);
  for (int y = 0; y < 12; ++y) std::memcpy(expected.row(y), part.row(y), 20 * 3);
  ExpectIsReadAgain(EncodeJpeg(part, 95), expected);
}

TEST(WriteJpeg, RowsAreReadAgain) {
  for (const int channels : {1, 3})
    for (const int height : {1, 32, 33, 70}) {
      const Image<uint8_t> image = Gradient(45, height, channels);
      ExpectIsReadAgain(EncodeJpegRows(JpegRows(image)), image);
    }
}

TEST(WriteJpeg, RowsKeepFullChroma) {
  const Image<uint8_t> image = Gradient(45, 20, 3);
  // A frame header states 8 bits, height, width, and id, sampling and table of each component.
  const std::string frame("\xff\xc0\0\x11\x08\0\x14\0\x2d\x03\x01\x11\0\x02\x11\1\x03\x11\1", 19);
  EXPECT_NE(EncodeJpegRows(JpegRows(image))->find(frame), std::string::npos);
}

TEST(WriteJpeg, MetadataAreComments) {
  const Image<uint8_t> image = Gradient(45, 20, 3);
  PictureRows picture = JpegRows(image);
  EXPECT_EQ(EncodeJpegRows(picture)->find("\xff\xfe"), std::string::npos);
  picture.metadata = {{"lf.frame", 12}, {"lf.time_s", 0.25}};
  const std::string lines = "lf.frame: 12\nlf.time_s: 0.25\n";
  const std::string comment = std::string("\xff\xfe\0", 3) + static_cast<char>(2 + lines.size());
  EXPECT_NE(EncodeJpegRows(picture)->find(comment + lines), std::string::npos);
  picture.metadata = {{"key", std::string(100000, 'a')}};
  const std::string file = EncodeJpegRows(picture).value();
  EXPECT_EQ(std::count(file.begin(), file.end(), 'a') / 1000, 100);
  ExpectIsReadAgain(file, image);
}

TEST(WriteJpeg, InterruptionsEndTheEncoding) {
  const Image<uint8_t> image = Gradient(45, 100, 3);
  PictureRows picture = JpegRows(image);
  int asked = 0;
  picture.is_interrupted = [&] { return ++asked == 3; };
  const auto file = EncodeJpegRows(picture);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(asked, 3);
}

TEST(WriteJpeg, SaysWhatCannotBeEncoded) {
  const Image<uint8_t> wide(65501, 1, 3);
  const auto bytes = EncodeJpeg(wide.view(), 90);
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().kind, ErrorKind::kOutput);
  EXPECT_NE(bytes.error().message.find("65500"), std::string::npos) << bytes.error().message;
  const auto rows = EncodeJpegRows(JpegRows(wide));
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.error().kind, ErrorKind::kOutput);
  EXPECT_NE(rows.error().message.find("a.jpg: cannot be encoded: "), std::string::npos);
  EXPECT_NE(rows.error().message.find("65500"), std::string::npos) << rows.error().message;
}

}  // namespace
}  // namespace lf
