// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/frame_file.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/core/file.h"
#include "lf/core/random.h"
#include "lf/film/develop/display.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class FrameFileTest : public FolderTest {
 protected:
  // Returns the display values of a frame's colours, which are multiplied with the opacity already.
  Image<uint8_t> OverBlack(DevelopedFrame frame) const {
    frame.opacity = {};
    EXPECT_TRUE(WriteFrame(folder_ / "over_black.png", frame, FrameFormat::kPng8, {}));
    return std::get<Image<uint8_t>>(ReadImage(folder_ / "over_black.png").value());
  }
};

DevelopedFrame RandomFrame(int width, int height) {
  DevelopedFrame frame{Image<float>(width, height, 3), Image<uint32_t>(width, height, 3),
                       Image<float>(width, height)};
  uint64_t i = 0;
  for (float& value : frame.rgb.pixels())
    value = static_cast<float>(1.4 * RandomUnit(7, 0, i++) - 0.2);
  for (uint32_t& count : frame.ray_count.pixels())
    count = static_cast<uint32_t>(RandomBits(7, 1, i++) % (1u << 24));
  for (float& share : frame.coverage.pixels()) share = static_cast<float>(i++ % 4) / 3;
  return frame;
}

int ChannelNamed(const ImageFileInfo& info, const std::string& name) {
  const auto found = std::find(info.channel_names.begin(), info.channel_names.end(), name);
  EXPECT_NE(found, info.channel_names.end()) << name;
  return static_cast<int>(found - info.channel_names.begin());
}

TEST_F(FrameFileTest, ExrHoldsColoursCountsAndCoverage) {
  const DevelopedFrame frame = RandomFrame(11, 6);
  for (const FrameFormat format : {FrameFormat::kExrHalf, FrameFormat::kExrFloat}) {
    const auto path = FramePath(folder_, FrameId{3}, format);
    ASSERT_TRUE(WriteFrame(path, frame, format, {}));
    const ImageFileInfo info = ReadImageInfo(path).value();
    ASSERT_EQ(info.channels, 7);
    const auto read = std::get<Image<float>>(ReadImage(path).value());
    const int count[] = {ChannelNamed(info, "count_red"), ChannelNamed(info, "count_green"),
                         ChannelNamed(info, "count_blue")};
    const int coverage = ChannelNamed(info, "coverage");
    const float tolerance = format == FrameFormat::kExrFloat ? 0 : 1.0f / 2048;
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 11; ++x) {
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(read.at(x, y, c), frame.rgb.at(x, y, c), tolerance);
          ASSERT_EQ(read.at(x, y, count[c]), static_cast<float>(frame.ray_count.at(x, y, c)));
        }
        ASSERT_NEAR(read.at(x, y, coverage), frame.coverage.at(x, y), tolerance);
      }
  }
}

TEST_F(FrameFileTest, ExrHoldsEffectiveCountsWhereThereAreSome) {
  DevelopedFrame frame = RandomFrame(11, 6);
  frame.effective_count = Image<float>(11, 6, 1, 12.5F);
  const auto path = FramePath(folder_, FrameId{3}, FrameFormat::kExrHalf);
  ASSERT_TRUE(WriteFrame(path, frame, FrameFormat::kExrHalf, {}));
  const ImageFileInfo info = ReadImageInfo(path).value();
  ASSERT_EQ(info.channels, 8);
  const auto read = std::get<Image<float>>(ReadImage(path).value());
  EXPECT_EQ(read.at(10, 5, ChannelNamed(info, "effective")), 12.5F);
}

TEST_F(FrameFileTest, ExrHoldsFocusDepthsAsFloats) {
  DevelopedFrame frame = RandomFrame(11, 6);
  frame.focus_depth_w = Image<float>(11, 6, 1, 1234.5678F);
  const auto path = folder_ / "z.exr";
  ASSERT_TRUE(WriteFrame(path, frame, FrameFormat::kExrHalf, {}));
  const auto read = std::get<Image<float>>(ReadImage(path).value());
  EXPECT_EQ(read.at(10, 5, ChannelNamed(ReadImageInfo(path).value(), "Z")), 1234.5678F);
}

// Blender's sequencer shows no file with layers, and takes the last letter of a name for a colour.
TEST_F(FrameFileTest, NoChannelIsOfALayerOrEndsLikeAColour) {
  DevelopedFrame frame = RandomFrame(4, 4);
  for (Image<float>* const more : {&frame.opacity, &frame.effective_count, &frame.interpolated,
                                   &frame.densified, &frame.trust, &frame.focus_depth_w})
    *more = Image<float>(4, 4, 1, 1.0F);
  const auto path = folder_ / "all.exr";
  ASSERT_TRUE(WriteFrame(path, frame, FrameFormat::kExrHalf, {}));
  const ImageFileInfo info = ReadImageInfo(path).value();
  ASSERT_EQ(info.channels, 13);
  for (const std::string& name : info.channel_names) {
    EXPECT_EQ(name.find('.'), std::string::npos) << name;
    if (name.size() > 1) {
      EXPECT_EQ(std::string("rgbaxyzRGBAXYZ").find(name.back()), std::string::npos) << name;
    }
  }
}

TEST_F(FrameFileTest, FewerChannelsHaveTheSameLight) {
  DevelopedFrame frame = RandomFrame(11, 40);
  frame.opacity = Image<float>(11, 40, 1, 0.5F);
  frame.focus_depth_w = Image<float>(11, 40, 1, 7.0F);
  const auto names_and_light = [&](const PictureOptions& options, const DevelopedFrame& of) {
    const auto path = folder_ / "few.exr";
    EXPECT_TRUE(WriteFrame(path, of, FrameFormat::kExrFloat, {}, {}, options));
    std::vector<std::string> names = ReadImageInfo(path).value().channel_names;
    const auto read = std::get<Image<float>>(ReadImage(path).value());
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 11; ++x)
        for (int c = 0; c < 3; ++c) EXPECT_EQ(read.at(x, y, c), of.rgb.at(x, y, c));
    return names;
  };
  using Names = std::vector<std::string>;
  PictureOptions options;
  options.compression = ExrCompression::kZips;
  EXPECT_EQ(names_and_light(options, frame).size(), 9U);
  options.channels = FrameChannels::kRgba;
  EXPECT_EQ(names_and_light(options, frame), (Names{"R", "G", "B", "A", "Z"}));
  frame.focus_depth_w = {};
  EXPECT_EQ(names_and_light(options, frame), (Names{"R", "G", "B", "A"}));
  options.channels = FrameChannels::kRgb;
  EXPECT_EQ(names_and_light(options, frame), (Names{"R", "G", "B"}));
}

TEST_F(FrameFileTest, ChannelsHaveTheirNamesOnTheCommandLine) {
  for (const char* name : {"all", "rgba", "rgb"})
    EXPECT_STREQ(NameOf(*ParseFrameChannels(name)), name);
  EXPECT_EQ(ParseFrameChannels("RGB"), std::nullopt);
}

TEST_F(FrameFileTest, AFrameOfAnotherColourSpaceShowsTheSamePicture) {
  DevelopedFrame frame = RandomFrame(11, 6);
  const Image<uint8_t> picture = OverBlack(frame);
  for (const ColourSpace colours : {ColourSpace::kRec2020, ColourSpace::kAcesCg}) {
    DevelopedFrame converted = frame;
    ConvertFromRec709(colours, &converted.rgb);
    const auto path = folder_ / "c.exr";
    ASSERT_TRUE(WriteFrame(path, converted, FrameFormat::kExrFloat, {}));
    const Image<uint8_t> read = ReadDisplayImage(path, colours).value();
    for (size_t i = 0; i < picture.pixels().size(); ++i)
      ASSERT_NEAR(read.pixels()[i], picture.pixels()[i], 1);
    EXPECT_NE(ReadDisplayImage(path).value().pixels(), read.pixels());
  }
}

TEST_F(FrameFileTest, PngHoldsDisplayValuesRoundedToTheNearestStep) {
  const DevelopedFrame frame = RandomFrame(40, 30);
  ASSERT_TRUE(WriteFrame(folder_ / "a.png", frame, FrameFormat::kPng8, {}));
  const auto eight = std::get<Image<uint8_t>>(ReadImage(folder_ / "a.png").value());
  ASSERT_TRUE(WriteFrame(folder_ / "b.png", frame, FrameFormat::kPng16, {}));
  const auto sixteen = std::get<Image<uint16_t>>(ReadImage(folder_ / "b.png").value());
  ASSERT_EQ(eight.channels(), 3);
  for (size_t i = 0; i < frame.rgb.pixels().size(); ++i) {
    const double display = std::clamp(DisplayFromLinear(frame.rgb.pixels()[i]), 0.0, 1.0);
    ASSERT_NEAR(eight.pixels()[i], 255 * display, 0.5001);
    ASSERT_NEAR(sixteen.pixels()[i], 65535 * display, 0.51);
  }
}

TEST_F(FrameFileTest, AWrittenFrameShowsTheSamePicture) {
  const DevelopedFrame frame = RandomFrame(40, 30);
  const Image<uint8_t> picture = OverBlack(frame);
  for (const FrameFormat format :
       {FrameFormat::kExrHalf, FrameFormat::kExrFloat, FrameFormat::kPng8, FrameFormat::kPng16}) {
    const auto path = FramePath(folder_, FrameId{1}, format);
    ASSERT_TRUE(WriteFrame(path, frame, format, {}));
    const Image<uint8_t> read = ReadDisplayImage(path).value();
    // Half and 16-bit values are rounded once more.
    const bool exact = format == FrameFormat::kExrFloat || format == FrameFormat::kPng8;
    for (size_t i = 0; i < picture.pixels().size(); ++i)
      ASSERT_NEAR(read.pixels()[i], picture.pixels()[i], exact ? 0 : 1);
  }
  ASSERT_TRUE(WriteImage(folder_ / "grey.png", Image<uint8_t>(2, 2, 1).view()));
  EXPECT_EQ(ReadDisplayImage(folder_ / "grey.png").error().kind, ErrorKind::kInput);
  EXPECT_EQ(ReadDisplayImage(folder_ / "none.png").error().kind, ErrorKind::kInput);
}

DevelopedFrame FrameWithOpacity(int width, int height) {
  DevelopedFrame frame = RandomFrame(width, height);
  frame.opacity = Image<float>(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      frame.opacity.at(x, y) = static_cast<float>((x + y) % 5) / 4;
      for (int c = 0; c < 3; ++c)
        frame.rgb.at(x, y, c) =
            frame.opacity.at(x, y) * static_cast<float>(RandomUnit(9, c, x + 100 * y));
    }
  return frame;
}

TEST_F(FrameFileTest, ExrHasAlphaBesideColoursThatAreMultipliedWithIt) {
  const DevelopedFrame frame = FrameWithOpacity(11, 6);
  const auto path = folder_ / "a.exr";
  ASSERT_TRUE(WriteFrame(path, frame, FrameFormat::kExrFloat, {}));
  const ImageFileInfo info = ReadImageInfo(path).value();
  ASSERT_EQ(info.channels, 8);
  EXPECT_EQ(ChannelNamed(info, "A"), 3);
  const auto read = std::get<Image<float>>(ReadImage(path).value());
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 11; ++x) {
      for (int c = 0; c < 3; ++c) ASSERT_EQ(read.at(x, y, c), frame.rgb.at(x, y, c));
      ASSERT_EQ(read.at(x, y, 3), frame.opacity.at(x, y));
    }
}

TEST_F(FrameFileTest, PngHasStraightColoursAndAlpha) {
  const DevelopedFrame frame = FrameWithOpacity(11, 6);
  const auto path = folder_ / "a.png";
  ASSERT_TRUE(WriteFrame(path, frame, FrameFormat::kPng16, {}));
  const auto read = std::get<Image<uint16_t>>(ReadImage(path).value());
  ASSERT_EQ(read.channels(), 4);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 11; ++x) {
      const auto a = static_cast<double>(frame.opacity.at(x, y));
      ASSERT_NEAR(read.at(x, y, 3), 65535 * a, 0.51);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(read.at(x, y, c),
                    a > 0 ? 65535 * DisplayFromLinear(frame.rgb.at(x, y, c) / a) : 0, 0.52);
    }
}

TEST_F(FrameFileTest, FramesWithAlphaAreShownOverBlack) {
  const DevelopedFrame frame = FrameWithOpacity(40, 30);
  const Image<uint8_t> picture = OverBlack(frame);
  for (const FrameFormat format :
       {FrameFormat::kExrFloat, FrameFormat::kPng8, FrameFormat::kPng16}) {
    const auto path = FramePath(folder_, FrameId{1}, format);
    ASSERT_TRUE(WriteFrame(path, frame, format, {}));
    const Image<uint8_t> read = ReadDisplayImage(path).value();
    ASSERT_EQ(read.channels(), 3);
    for (size_t i = 0; i < picture.pixels().size(); ++i)
      ASSERT_NEAR(read.pixels()[i], picture.pixels()[i], format == FrameFormat::kExrFloat ? 0 : 1);
  }
}

TEST_F(FrameFileTest, MetadataIsInTheFile) {
  const DevelopedFrame frame = RandomFrame(4, 4);
  for (const FrameFormat format : {FrameFormat::kExrHalf, FrameFormat::kPng16}) {
    const auto path = FramePath(folder_, FrameId{1}, format);
    ASSERT_TRUE(WriteFrame(path, frame, format, {{"lf.focus_distance_w", 0.5}, {"lf.path", "p"}}));
    EXPECT_NE(ReadFile(path).value().find("lf.focus_distance_w"), std::string::npos);
  }
}

TEST_F(FrameFileTest, EqualFramesAreEqualFiles) {
  const DevelopedFrame frame = RandomFrame(16, 16);
  for (const FrameFormat format : {FrameFormat::kExrHalf, FrameFormat::kPng8}) {
    const auto a = FramePath(folder_, FrameId{1}, format),
               b = FramePath(folder_, FrameId{2}, format);
    ASSERT_TRUE(WriteFrame(a, frame, format, {{"x", 1}}));
    ASSERT_TRUE(WriteFrame(b, frame, format, {{"x", 1}}));
    EXPECT_EQ(ReadFile(a).value(), ReadFile(b).value());
  }
}

TEST_F(FrameFileTest, AnInterruptionIsAnsweredWithinSomeRowsAndLeavesNoFile) {
  const int height = 200;
  const DevelopedFrame frame = RandomFrame(9, height);
  for (const FrameFormat format :
       {FrameFormat::kExrHalf, FrameFormat::kExrFloat, FrameFormat::kPng8, FrameFormat::kPng16}) {
    const auto path = FramePath(folder_, FrameId{1}, format);
    int asked = 0, last = 0;
    const auto is_interrupted = [&] { return ++asked == last; };
    ASSERT_TRUE(WriteFrame(path, frame, format, {}, is_interrupted));
    const std::string whole = ReadFile(path).value();
    const int all = asked;
    EXPECT_GE(all, height / 32);
    for (const int question : {1, all / 2, all}) {
      std::filesystem::remove(path);
      asked = 0;
      last = question;
      const auto result = WriteFrame(path, frame, format, {}, is_interrupted);
      ASSERT_FALSE(result);
      EXPECT_EQ(result.error().kind, ErrorKind::kInterrupted);
      EXPECT_EQ(asked, question);
      EXPECT_TRUE(std::filesystem::is_empty(folder_));
    }
    ASSERT_TRUE(WriteFrame(path, frame, format, {}));
    EXPECT_EQ(ReadFile(path).value(), whole);
    std::filesystem::remove(path);
  }
}

TEST_F(FrameFileTest, NamesCountFromOneWithFourDigits) {
  EXPECT_EQ(FramePath("out", FrameId{1}, FrameFormat::kExrHalf), "out/frame_0001.exr");
  EXPECT_EQ(FramePath("out", FrameId{900}, FrameFormat::kPng16), "out/frame_0900.png");
  EXPECT_EQ(FramePath("out", FrameId{12345}, FrameFormat::kExrFloat), "out/frame_12345.exr");
}

TEST_F(FrameFileTest, FormatsHaveTheirNamesOnTheCommandLine) {
  EXPECT_EQ(ParseFrameFormat("exr"), FrameFormat::kExrHalf);
  EXPECT_EQ(ParseFrameFormat("exr-float"), FrameFormat::kExrFloat);
  for (const char* name : {"exr", "exr-float", "png", "png16"})
    EXPECT_STREQ(NameOf(*ParseFrameFormat(name)), name);
  EXPECT_EQ(ParseFrameFormat("png"), FrameFormat::kPng8);
  EXPECT_EQ(ParseFrameFormat("png16"), FrameFormat::kPng16);
  EXPECT_EQ(ParseFrameFormat("jpg"), std::nullopt);
  EXPECT_EQ(ParseFrameFormat(""), std::nullopt);
}

TEST_F(FrameFileTest, AMissingFolderIsAnOutputError) {
  for (const FrameFormat format : {FrameFormat::kExrHalf, FrameFormat::kPng8}) {
    const auto result =
        WriteFrame(FramePath(folder_ / "none", FrameId{1}, format), RandomFrame(2, 2), format, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::kOutput);
  }
}

}  // namespace
}  // namespace lf
