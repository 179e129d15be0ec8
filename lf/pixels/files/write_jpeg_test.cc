#include "lf/pixels/files/write_jpeg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <variant>

#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {

TEST(WriteJpeg, IsReadAgain) {
  Image<uint8_t> image(70, 33, 3);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<uint8_t>(40 + 2 * x + y + 10 * c);
  const auto bytes = EncodeJpeg(image.view(), 95);
  ASSERT_TRUE(bytes);
  const auto read = ReadImageBytes(*bytes, "a.jpg");
  ASSERT_TRUE(read) << read.error().message;
  const auto& again = std::get<Image<uint8_t>>(*read);
  ASSERT_EQ(again.width(), 70);
  ASSERT_EQ(again.height(), 33);
  double sum = 0;
  for (size_t i = 0; i < image.pixels().size(); ++i)
    sum += std::abs(int{image.pixels()[i]} - int{again.pixels()[i]});
  EXPECT_LT(sum / static_cast<double>(image.pixels().size()), 3);
}

TEST(WriteJpeg, SaysWhatCannotBeEncoded) {
  const Image<uint8_t> wide(65501, 1, 3);
  const auto bytes = EncodeJpeg(wide.view(), 90);
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().kind, ErrorKind::kOutput);
  EXPECT_NE(bytes.error().message.find("65500"), std::string::npos) << bytes.error().message;
}

}  // namespace
}  // namespace lf
