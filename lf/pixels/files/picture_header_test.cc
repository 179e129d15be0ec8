// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/picture_header.h"

#include <gtest/gtest.h>

#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

using PictureHeaderTest = FolderTest;

constexpr std::array<float, 8> kSomePrimaries = {0.7f, 0.3f, 0.2f, 0.7f, 0.1f, 0.1f, 0.3f, 0.3f};

// Expects that a picture that is written with these facts states them, and has the same pixels.
void ExpectKept(const std::filesystem::path& path, const StoredImage& pixels,
                const std::vector<std::string>& names, const ColourFacts& colours) {
  const auto written =
      WriteStoredImage(path, pixels, names, colours, {{"lf:more", std::string("yes")}});
  ASSERT_TRUE(written) << written.error().message;
  const auto header = ReadPictureHeader(path);
  ASSERT_TRUE(header) << header.error().message;
  EXPECT_EQ(header->colours, colours);
  EXPECT_EQ(header->info.channel_names, names);
  const StoredImage read = ReadImage(path).value();
  ASSERT_EQ(read.index(), pixels.index());
  std::visit(
      [&](const auto& image) {
        using Kind = std::remove_cvref_t<decltype(image)>;
        EXPECT_EQ(image.pixels(), std::get<Kind>(pixels).pixels());
      },
      read);
}

TEST_F(PictureHeaderTest, FactsAndPixelsOfExrFilesAreKept) {
  Image<float> image(5, 3, 4);
  for (int i = 0; i < 60; ++i) image.pixels()[i] = static_cast<float>(i) / 8;  // exact as half
  for (const PixelType type : {PixelType::kHalf, PixelType::kFloat}) {
    ExpectKept(folder_ / "a.exr", image, {"R", "G", "B", "A"}, {type, kSomePrimaries, 12.5});
    ExpectKept(folder_ / "b.exr", image, {"R", "G", "B", "A"}, {type});
  }
}

TEST_F(PictureHeaderTest, FactsAndPixelsOfPngFilesAreKept) {
  for (const bool is_srgb : {true, false}) {
    ColourFacts facts = {PixelType::kUint8, std::nullopt, 23.976, is_srgb};
    ExpectKept(folder_ / "a.png", NoiseImage<uint8_t>(7, 4, 3), {"R", "G", "B"}, facts);
    facts = {PixelType::kUint16, std::nullopt, std::nullopt, is_srgb};
    ExpectKept(folder_ / "b.png", NoiseImage<uint16_t>(7, 4, 4), {"R", "G", "B", "A"}, facts);
  }
}

TEST_F(PictureHeaderTest, TheCameraIsReadIfAllOfItIsStated) {
  const auto camera_of = [&](const std::string& name, const std::string& position) {
    const ImageMetadata metadata = {{"lf:position", position},
                                    {"lf:forward", std::string("0 0 1")},
                                    {"lf:up", std::string("0 -1 0")}};
    const bool is_exr = name.ends_with("exr");
    const StoredImage pixels = is_exr ? StoredImage(NoiseImage<float>(4, 3, 3))
                                      : StoredImage(NoiseImage<uint8_t>(4, 3, 3));
    const ColourFacts facts = {is_exr ? PixelType::kHalf : PixelType::kUint8};
    EXPECT_TRUE(WriteStoredImage(folder_ / name, pixels, {"R", "G", "B"}, facts, metadata));
    return ReadPictureHeader(folder_ / name).value().colours.camera;
  };
  for (const std::string name : {"a.png", "a.exr"}) {
    const auto camera = camera_of(name, "1.5 -2e-3 7");
    ASSERT_TRUE(camera) << name;
    EXPECT_EQ(*camera, (StatedCamera{{1.5, -2e-3, 7}, {0, 0, 1}, {0, -1, 0}}));
    for (const std::string wrong : {"", "1 2", "1 2 3 4", "1 2 x", "1 2 nan", "1,2,3"})
      EXPECT_FALSE(camera_of(name, wrong)) << name << ": " << wrong;
  }
}

TEST_F(PictureHeaderTest, ColoursAreHalfOnlyIfAllOfThemAre) {
  const Image<float> image = NoiseImage<float>(4, 4, 1);
  const Image<uint32_t> counts = NoiseImage<uint32_t>(4, 4, 1);
  const auto type_of = [&](bool blue_is_half) {
    const std::vector<ExrChannel> channels = {{"R", image.view(), 0, true},
                                              {"G", image.view(), 0, true},
                                              {"B", image.view(), 0, blue_is_half},
                                              {"Z", image.view(), 0, false},
                                              {"count.R", counts.view(), 0}};
    EXPECT_TRUE(WriteExr(folder_ / "a.exr", channels));
    return ReadPictureHeader(folder_ / "a.exr").value().colours.type;
  };
  EXPECT_EQ(type_of(true), PixelType::kHalf);
  EXPECT_EQ(type_of(false), PixelType::kFloat);
}

TEST_F(PictureHeaderTest, ARateThatIsNoNumberIsNotStated) {
  for (const char* rate : {"fast", "25 fps", "0", "-3", "inf", "nan", ""}) {
    ASSERT_TRUE(WriteStoredImage(folder_ / "a.png", NoiseImage<uint8_t>(3, 3, 3), {"R", "G", "B"},
                                 {}, {{kFrameRateText, std::string(rate)}}));
    EXPECT_EQ(ReadPictureHeader(folder_ / "a.png").value().colours.frames_per_second, std::nullopt)
        << rate;
  }
}

TEST_F(PictureHeaderTest, NothingIsWrittenAfterAnInterruption) {
  const auto written = WriteStoredImage(folder_ / "a.png", NoiseImage<uint8_t>(3, 3, 3),
                                        {"R", "G", "B"}, {}, {}, [] { return true; });
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kInterrupted);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.png"));
}

TEST_F(PictureHeaderTest, ExrFilesStateTheirCamera) {
  const Image<float> image = NoiseImage<float>(5, 3, 1);
  std::array<float, 16> matrix = {};
  for (size_t i = 0; i < 16; ++i) matrix[i] = static_cast<float>(i) + 0.5f;
  const std::vector<ExrChannel> channels = {{"Z", image.view(), 0, false}};
  ASSERT_TRUE(WriteExr(folder_ / "a.exr", channels, {{"worldToNDC", matrix}, {"lf:unit_m", 0.25}}));
  const StatedProjection facts = ReadPictureHeader(folder_ / "a.exr").value().projection;
  EXPECT_EQ(facts.world_to_ndc, matrix);
  EXPECT_EQ(facts.unit_m, 0.25);
  EXPECT_EQ(facts.display_width, 5);
  EXPECT_EQ(facts.display_height, 3);
  EXPECT_EQ(facts.left, 0);
  EXPECT_EQ(facts.top, 0);
  ASSERT_TRUE(WriteExr(folder_ / "b.exr", channels));
  const StatedProjection none = ReadPictureHeader(folder_ / "b.exr").value().projection;
  EXPECT_FALSE(none.world_to_ndc || none.unit_m);
}

}  // namespace
}  // namespace lf
