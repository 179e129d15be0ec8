// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/picture_light.h"

#include <gtest/gtest.h>

#include "lf/film/develop/colour_space.h"
#include "lf/film/develop/display.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_header.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class PictureLightTest : public FolderTest {
 protected:
  Image<float> RgbOf(const std::string& name) const {
    const auto picture = ReadPictureLight(folder_ / name);
    EXPECT_TRUE(picture) << picture.error().message;
    return picture ? picture->rgb : Image<float>(1, 1, 3);
  }
  template <class T>
  static Image<T> Pixel(std::initializer_list<T> values) {
    Image<T> pixel(1, 1, static_cast<int>(values.size()));
    std::copy(values.begin(), values.end(), pixel.pixels().begin());
    return pixel;
  }
  // Returns the facts of a file of floats that states primaries.
  static ColourFacts FactsWith(ColourSpace space) {
    const Primaries primaries = PrimariesOf(space);
    ColourFacts facts{.type = PixelType::kFloat};
    facts.chromaticities.emplace();
    int i = 0;
    for (const Vec2& point : {primaries.red, primaries.green, primaries.blue, primaries.white})
      for (int axis = 0; axis < 2; ++axis)
        (*facts.chromaticities)[i++] = static_cast<float>(point[axis]);
    return facts;
  }
};

TEST_F(PictureLightTest, IntegersAreSrgbAndMultipliedByAlpha) {
  ASSERT_TRUE(WriteImage(folder_ / "a.png", Pixel<uint8_t>({255, 128, 0}).view()));
  ASSERT_TRUE(WriteImage(folder_ / "b.png", Pixel<uint16_t>({65535, 30000, 0, 32768}).view()));
  ASSERT_TRUE(WriteImage(folder_ / "c.png", Pixel<uint8_t>({128}).view()));
  const auto half = static_cast<float>(LinearFromDisplay(128.0 / 255));
  const Image<float> a = RgbOf("a.png"), b = RgbOf("b.png"), c = RgbOf("c.png");
  EXPECT_EQ(a.at(0, 0, 0), 1);
  EXPECT_EQ(a.at(0, 0, 1), half);
  EXPECT_EQ(a.at(0, 0, 2), 0);
  const float alpha = 32768.0f / 65535;
  EXPECT_EQ(b.at(0, 0, 0), alpha);
  EXPECT_FLOAT_EQ(b.at(0, 0, 1), alpha * static_cast<float>(LinearFromDisplay(30000.0 / 65535)));
  for (int channel = 0; channel < 3; ++channel) EXPECT_EQ(c.at(0, 0, channel), half);
}

TEST_F(PictureLightTest, PrimariesThatAFileStatesAreConverted) {
  Image<float> light = Pixel<float>({0.2f, 0.5f, 3.0f});
  const Image<float> expected = light;
  ConvertFromRec709(ColourSpace::kAcesCg, &light);
  ASSERT_TRUE(WriteStoredImage(folder_ / "aces.exr", light, {"R", "G", "B"},
                               FactsWith(ColourSpace::kAcesCg)));
  const Image<float> found = RgbOf("aces.exr");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.at(0, 0, c), expected.at(0, 0, c), 1e-5);
}

TEST_F(PictureLightTest, FloatsWithThePrimariesOfSrgbStayAsTheyAre) {
  const Image<float> pixel = Pixel<float>({0.1f, 0.7f, 3.3f});
  ASSERT_TRUE(WriteStoredImage(folder_ / "rec709.exr", pixel, {"R", "G", "B"},
                               FactsWith(ColourSpace::kRec709)));
  EXPECT_EQ(RgbOf("rec709.exr").pixels(), pixel.pixels());
}

TEST_F(PictureLightTest, CoverageIsReadAndChannelsAreFoundByName) {
  const Image<float> pixel = Pixel<float>({0.25f, 0.5f, 0.75f, 1});
  std::vector<ExrChannel> channels;
  for (const auto& [name, channel] : {std::pair("B", 2), std::pair("G", 1), std::pair("R", 0),
                                      std::pair("coverage", 1), std::pair("A", 3)})
    channels.push_back({.name = name, .pixels = pixel.view(), .channel = channel});
  ASSERT_TRUE(WriteExr(folder_ / "frame.exr", channels));
  const auto picture = ReadPictureLight(folder_ / "frame.exr");
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->rgb.at(0, 0, 0), 0.25f);
  EXPECT_EQ(picture->rgb.at(0, 0, 2), 0.75f);
  ASSERT_TRUE(picture->coverage);
  EXPECT_EQ(picture->coverage->at(0, 0), 0.5f);
}

TEST_F(PictureLightTest, PicturesWithoutColoursAreErrors) {
  const Image<float> pixel = Pixel<float>({1, 2});
  ASSERT_TRUE(
      WriteExr(folder_ / "normals.exr",
               std::vector<ExrChannel>{{.name = "X", .pixels = pixel.view(), .channel = 0},
                                       {.name = "Z", .pixels = pixel.view(), .channel = 1}}));
  const auto picture = ReadPictureLight(folder_ / "normals.exr");
  ASSERT_FALSE(picture);
  EXPECT_NE(picture.error().message.find("has the channels X, Z, expected R, G and B"),
            std::string::npos)
      << picture.error().message;
}

TEST_F(PictureLightTest, AnImageInMemoryIsReadAsItsFile) {
  const auto expect_equal = [&](const auto& pixel) {
    ASSERT_TRUE(WriteImage(folder_ / "a.png", pixel.view()));
    const auto picture = PictureLightOf(pixel);
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_EQ(picture->rgb.pixels(), RgbOf("a.png").pixels());
    EXPECT_FALSE(picture->coverage);
  };
  expect_equal(Pixel<uint8_t>({200}));
  expect_equal(Pixel<uint8_t>({200, 100}));
  expect_equal(Pixel<uint16_t>({65535, 30000, 7}));
  expect_equal(Pixel<uint8_t>({200, 100, 50, 128}));
}

TEST_F(PictureLightTest, FloatsInMemoryAreLightThatAlphaIsMultipliedInto) {
  const auto picture = PictureLightOf(Pixel<float>({0.5f, 0.25f, -1, 0.1f}));
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->rgb.pixels(), Pixel<float>({0.5f, 0.25f, -1}).pixels());
  const auto wide = PictureLightOf(Image<float>(1, 1, 5));
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.error().message, "has 5 channels, expected 1 to 4");
}

}  // namespace
}  // namespace lf
