// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/transmission.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

Image<uint8_t> PictureOf(int width, int height, std::initializer_list<int> shares) {
  Image<uint8_t> picture(width, height);
  auto to = picture.pixels().begin();
  for (const int share : shares) *to++ = static_cast<uint8_t>(share);
  return picture;
}

Transmission Parsed(const std::string& text) {
  const auto read = Transmission::FromText(text);
  EXPECT_TRUE(read) << text;
  return *read;
}

TEST(TransmissionTest, TextComesBack) {
  const Transmission transmission = Parsed("00ff80/010203/aabbcc");
  EXPECT_EQ(transmission.side(), 3);
  EXPECT_EQ(transmission.Share(1, 0), 255);
  EXPECT_EQ(transmission.Share(0, 2), 0xaa);
  EXPECT_EQ(transmission.Text(), "00ff80/010203/aabbcc");
  EXPECT_NEAR(transmission.Mean(), (255 + 128 + 1 + 2 + 3 + 170 + 187 + 204) / 9.0 / 255, 1e-15);
}

TEST(TransmissionTest, RefusesOtherTexts) {
  std::string large;
  for (int row = 0; row < 65; ++row) large += (row > 0 ? "/" : "") + std::string(130, 'f');
  for (const std::string& text :
       {std::string(), std::string("0"), std::string("0g"), std::string("FF"), std::string("ffff"),
        std::string("ffff/ff"), std::string("ff/ff"), std::string("ffff/ffff/"), std::string("/"),
        large, large.substr(0, 130) + "/"})
    EXPECT_FALSE(Transmission::FromText(text)) << text;
  EXPECT_NE(Transmission::FromText("0000/0000").error().message.find("dark"), std::string::npos);
}

TEST(TransmissionTest, CentresPicturesThatAreNoSquare) {
  EXPECT_EQ(Transmission::Of(PictureOf(3, 1, {10, 20, 30}))->Text(), "000000/0a141e/000000");
  EXPECT_EQ(Transmission::Of(PictureOf(1, 3, {10, 20, 30}))->Text(), "000a00/001400/001e00");
  EXPECT_FALSE(Transmission::Of(PictureOf(1, 1, {0})));
  EXPECT_FALSE(Transmission::Of({}));
}

TEST(TransmissionTest, ReducesLargePictures) {
  Image<uint8_t> picture(128, 128);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) picture.at(x, y) = static_cast<uint8_t>(x < 64 ? 4 * (x % 2) : y);
  const auto reduced = Transmission::Of(picture);
  ASSERT_TRUE(reduced);
  EXPECT_EQ(reduced->side(), 64);
  EXPECT_EQ(reduced->Share(5, 9), 2);
  EXPECT_EQ(reduced->Share(40, 10), 21);  // the mean of rows 20 and 21, rounded
  // 130 pixels take blocks of 3, 44 places across, centred.
  EXPECT_EQ(Transmission::Of(Image<uint8_t>(130, 130, 1, 90))->side(), 44);
  EXPECT_EQ(Transmission::Of(Image<uint8_t>(130, 130, 1, 90))->Share(22, 22), 90);
}

TEST(TransmissionTest, IsUprightAndTurnsWithTheBlades) {
  const Transmission transmission = Parsed("10203040/50607080/90a0b0c0/d0e0f0ff");
  const auto at = [&](double right, double up, double rotation_rad, double ratio) {
    const Aperture aperture{2, 0, rotation_rad, ratio, 0};
    return static_cast<int>(std::lround(255 * LightThrough(transmission, aperture, {right, up})));
  };
  EXPECT_EQ(at(-1.5, 1.5, 0, 1), 0x10);
  EXPECT_EQ(at(1.5, 1.5, 0, 1), 0x40);
  EXPECT_EQ(at(-1.5, -1.5, 0, 1), 0xd0);
  EXPECT_EQ(at(0.5, 0.5, 0, 1), 0x70);
  EXPECT_EQ(at(2.1, 0, 0, 1), 0);
  EXPECT_EQ(at(0, -2.1, 0, 1), 0);
  // A quarter of a turn counter-clockwise takes the right edge up.
  EXPECT_EQ(at(-1.5, 1.5, kPi / 2, 1), 0x40);
  EXPECT_EQ(at(1.5, 1.5, kPi / 2, 1), 0xff);
  // With the ratio 2, the opening is half as wide; with 1/2, half as high.
  EXPECT_EQ(at(0.75, 1.5, 0, 2), 0x40);
  EXPECT_EQ(at(1.1, 1.5, 0, 2), 0);
  EXPECT_EQ(at(1.5, 0.75, 0, 0.5), 0x40);
}

TEST(TransmissionTest, ComparesPictures) {
  const auto a = std::make_shared<const Transmission>(Parsed("ff"));
  const auto b = std::make_shared<const Transmission>(Parsed("fe"));
  EXPECT_TRUE(AreEqual(nullptr, nullptr));
  EXPECT_TRUE(AreEqual(a, std::make_shared<const Transmission>(Parsed("ff"))));
  EXPECT_FALSE(AreEqual(a, b));
  EXPECT_FALSE(AreEqual(a, nullptr));
}

}  // namespace
}  // namespace lf
