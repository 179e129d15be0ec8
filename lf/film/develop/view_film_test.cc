// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/view_film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <type_traits>

#include "lf/core/file.h"
#include "lf/film/develop/frame_file.h"
#include "lf/film/develop/join_views.h"
#include "lf/film/develop/view_frames.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class ViewFilmTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    fs::create_directories(views_ = folder_ / "views");
  }
  // Returns a picture whose every value tells frame, place and channel.
  template <class T>
  static Image<T> Picture(int frame, int width, int height, int channels) {
    Image<T> picture(width, height, channels);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < channels; ++c)
          picture.at(x, y, c) = static_cast<T>(1 + c + 4 * x + 29 * y + 53 * frame % 101);
    return picture;
  }
  template <class T>
  void WriteFrames(int first, int last, int width = 6, int height = 4, int channels = 3,
                   const ColourFacts& colours = {PixelType::kUint8, {}, {}, true}) const {
    const std::vector<std::string> names = {"R", "G", "B", "A"};
    const FrameFormat format =
        std::is_floating_point_v<T> ? FrameFormat::kExrHalf : FrameFormat::kPng8;
    for (int frame = first; frame <= last; ++frame)
      ASSERT_TRUE(WriteStoredImage(FramePath(views_, FrameId{static_cast<uint32_t>(frame)}, format),
                                   Picture<T>(frame, width, height, channels),
                                   {names.begin(), names.begin() + channels}, colours));
  }
  Result<ViewFilmReport> Write(const ViewFilmOptions& options) {
    return WriteViewFilm(std::vector<fs::path>{views_}, options, pool_, {});
  }
  std::string ErrorOf(const ViewFilmOptions& options, ErrorKind kind) {
    const auto written = Write(options);
    EXPECT_FALSE(written);
    if (written) return "";
    EXPECT_EQ(written.error().kind, kind) << written.error().message;
    return written.error().message;
  }
  template <class T>
  Image<T> Read(const std::string& name) const {
    const auto image = ReadImage(folder_ / name);
    EXPECT_TRUE(image) << image.error().message;
    return image ? std::get<Image<T>>(*image) : Image<T>();
  }

  fs::path views_;
  ThreadPool pool_{2};
};

// Expects that the tile of a joined picture is the picture of a frame.
template <class T>
void ExpectTile(const Image<T>& joined, int column, int row, const Image<T>& frame) {
  for (int y = 0; y < frame.height(); ++y)
    for (int x = 0; x < frame.width(); ++x)
      for (int c = 0; c < joined.channels(); ++c)
        ASSERT_EQ(joined.at(column * frame.width() + x, row * frame.height() + y, c),
                  frame.at(x, y, c));
}

void ExpectWords(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << message << "\nlacks " << word;
}

TEST_F(ViewFilmTest, QuiltsHaveTheBitsOfTheirViews) {
  const ColourFacts facts = {PixelType::kUint8, {}, 24, true};
  WriteFrames<uint8_t>(1, 12, 6, 4, 3, facts);
  const auto report = Write({ViewLayout::kQuilt, {3, 2}, folder_ / "q.png"});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->moment_count, 2u);
  ASSERT_EQ(report->files.size(), 2u);
  for (const int moment : {0, 1}) {
    const std::string name = "q_000" + std::to_string(moment + 1) + "_qs3x2a1.50.png";
    EXPECT_EQ(report->files[static_cast<size_t>(moment)], folder_ / name);
    EXPECT_EQ(ReadPictureHeader(folder_ / name).value().colours, facts);
    const auto quilt = Read<uint8_t>(name);
    ASSERT_EQ(quilt.width(), 18);
    ASSERT_EQ(quilt.height(), 8);
    for (int view = 0; view < 6; ++view)
      ExpectTile(quilt, view % 3, view < 3 ? 1 : 0,
                 Picture<uint8_t>(6 * moment + view + 1, 6, 4, 3));
  }
}

TEST_F(ViewFilmTest, SixteenBitsAndAlphaStay) {
  WriteFrames<uint16_t>(1, 2, 6, 4, 4, {PixelType::kUint16, {}, {}, false});
  ASSERT_TRUE(Write({ViewLayout::kOverUnder, {}, folder_ / "o.png"}));
  const auto joined = Read<uint16_t>("o.png");
  ASSERT_EQ(joined.channels(), 4);
  for (const int view : {0, 1}) ExpectTile(joined, 0, view, Picture<uint16_t>(view + 1, 6, 4, 4));
  EXPECT_FALSE(ReadPictureHeader(folder_ / "o.png").value().colours.is_srgb);
}

TEST_F(ViewFilmTest, ExrFilesKeepPrimariesTypeAndRateOfTheirColours) {
  const ColourFacts facts = {
      PixelType::kHalf, std::array<float, 8>{0.7f, 0.3f, 0.2f, 0.7f, 0.1f, 0.1f, 0.3f, 0.3f}, 25};
  WriteFrames<float>(1, 2, 6, 4, 4, facts);
  ASSERT_TRUE(Write({ViewLayout::kSideBySide, {}, folder_ / "s.exr"}));
  const auto joined = Read<float>("s.exr");
  ASSERT_EQ(joined.channels(), 4);
  for (const int view : {0, 1}) ExpectTile(joined, view, 0, Picture<float>(view + 1, 6, 4, 4));
  EXPECT_EQ(ReadPictureHeader(folder_ / "s.exr").value().colours, facts);
}

TEST_F(ViewFilmTest, ChannelsThatDescribeSingleViewsAreLeftOut) {
  const Image<float> rgb = Picture<float>(1, 6, 4, 3);
  const Image<uint32_t> count(6, 4, 1, 7);
  for (const char* name : {"frame_0001.exr", "frame_0002.exr"})
    ASSERT_TRUE(WriteExr(views_ / name, std::vector<ExrChannel>{{"R", rgb.view(), 0},
                                                                {"G", rgb.view(), 1},
                                                                {"B", rgb.view(), 2},
                                                                {"count.R", count.view(), 0}}));
  ASSERT_TRUE(Write({ViewLayout::kQuilt, {2, 1}, folder_ / "q.exr"}));
  const auto joined = Read<float>("q_qs2x1a1.50.exr");
  ASSERT_EQ(joined.channels(), 3);
  for (const int view : {0, 1}) ExpectTile(joined, view, 0, rgb);
}

TEST_F(ViewFilmTest, AnaglyphsHaveRedOfTheLeftEye) {
  WriteFrames<uint8_t>(1, 2);
  ASSERT_TRUE(Write({ViewLayout::kAnaglyph, {}, folder_ / "a.png"}));
  const auto joined = Read<uint8_t>("a.png");
  const auto left = Picture<uint8_t>(1, 6, 4, 3), right = Picture<uint8_t>(2, 6, 4, 3);
  ASSERT_EQ(joined.width(), 6);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x) {
      EXPECT_EQ(joined.at(x, y, 0), left.at(x, y, 0));
      EXPECT_EQ(joined.at(x, y, 1), right.at(x, y, 1));
      EXPECT_EQ(joined.at(x, y, 2), right.at(x, y, 2));
    }
}

TEST_F(ViewFilmTest, LeftAndRightPicturesAreCopiesOfTheFrames) {
  WriteFrames<float>(1, 4, 6, 4, 3, {PixelType::kHalf});
  const auto report = Write({ViewLayout::kLeftRight, {}, folder_ / "film.exr"});
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->files.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const std::string eye = i % 2 == 0 ? "left" : "right";
    const fs::path file = folder_ / ("film_" + eye + "_000" + std::to_string(i / 2 + 1) + ".exr");
    EXPECT_EQ(report->files[static_cast<size_t>(i)], file);
    EXPECT_EQ(ReadFile(file).value(),
              ReadFile(views_ / ("frame_000" + std::to_string(i + 1) + ".exr")).value());
  }
}

TEST_F(ViewFilmTest, FilesAreTakenInTheirOrder) {
  WriteFrames<uint8_t>(1, 2);
  const std::vector<fs::path> files = {views_ / "frame_0002.png", views_ / "frame_0001.png"};
  ASSERT_TRUE(WriteViewFilm(files, {ViewLayout::kSideBySide, {}, folder_ / "s.png"}, pool_, {}));
  ExpectTile(Read<uint8_t>("s.png"), 0, 0, Picture<uint8_t>(2, 6, 4, 3));
}

TEST_F(ViewFilmTest, MomentsOfAFolderMayBeginAnywhere) {
  WriteFrames<uint8_t>(5, 8);
  const auto report = Write({ViewLayout::kSideBySide, {}, folder_ / "s.png"});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->files[0], folder_ / "s_0003.png");
  EXPECT_EQ(report->files[1], folder_ / "s_0004.png");
}

// The moments of a film whose frames begin at another number have the numbers from there on.
TEST_F(ViewFilmTest, MomentsAreCountedFromTheFirstFrameOfTheFilm) {
  WriteFrames<uint8_t>(1, 4);
  for (int frame = 4; frame >= 1; --frame) {
    const fs::path from =
        FramePath(views_, FrameId{static_cast<uint32_t>(frame)}, FrameFormat::kPng8);
    fs::remove(from);
    ASSERT_TRUE(WriteStoredImage(
        FramePath(views_, FrameId{static_cast<uint32_t>(1002 + frame)}, FrameFormat::kPng8),
        Picture<uint8_t>(frame, 6, 4, 3), {"R", "G", "B"}, {PixelType::kUint8, {}, {}, true},
        {{kFirstFrameText, "1001"}}));
  }
  const auto report = Write({ViewLayout::kSideBySide, {}, folder_ / "s.png"});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->files[0], folder_ / "s_1002.png");
  EXPECT_EQ(report->files[1], folder_ / "s_1003.png");
  ASSERT_TRUE(WriteStoredImage(FramePath(views_, FrameId{1000}, FrameFormat::kPng8),
                               Picture<uint8_t>(1, 6, 4, 3), {"R", "G", "B"},
                               {PixelType::kUint8, {}, {}, true}, {{kFirstFrameText, "1001"}}));
  ExpectWords(ErrorOf({ViewLayout::kSideBySide, {}, folder_ / "t.png"}, ErrorKind::kInput),
              {"frame_1000.png", "comes before frame 1001"});
}

TEST_F(ViewFilmTest, AMissingViewIsNamed) {
  WriteFrames<uint8_t>(1, 6);
  const ViewFilmOptions options = {ViewLayout::kQuilt, {3, 1}, folder_ / "q.png"};
  fs::remove(views_ / "frame_0005.png");
  ExpectWords(ErrorOf(options, ErrorKind::kInput),
              {"frame 5 is missing", "view 2 of 3", "moment 2"});
  fs::remove(views_ / "frame_0006.png");
  ExpectWords(ErrorOf(options, ErrorKind::kInput), {"frame 5 is missing"});
  fs::remove(views_ / "frame_0001.png");
  ExpectWords(ErrorOf(options, ErrorKind::kInput), {"frame 1 is missing", "view 1 of 3"});
  EXPECT_TRUE(fs::is_empty(folder_) || !fs::exists(folder_ / "q_0001_qs3x1a1.50.png"));
}

TEST_F(ViewFilmTest, OtherCountsAndKindsOfFilesAreRefused) {
  WriteFrames<uint8_t>(1, 3);
  const ViewFilmOptions options = {ViewLayout::kSideBySide, {}, folder_ / "s.png"};
  const auto error = [&](const std::vector<fs::path>& files) {
    const auto written = WriteViewFilm(files, options, pool_, {});
    EXPECT_FALSE(written);
    return written ? "" : written.error().message;
  };
  const fs::path one = views_ / "frame_0001.png";
  ExpectWords(error({one}), {"the number of frames is 1", "multiple of 2"});
  ExpectWords(error({one, views_}), {"one folder"});
  ExpectWords(error({one, views_ / "a.tif"}), {"a.tif", ".png or .exr"});
  ExpectWords(error({one, views_ / "a.exr"}), {"one format"});
  ExpectWords(error({one, views_ / "no.png"}), {"no.png", "cannot be read"});
  ExpectWords(error({folder_}), {"has no frames"});
}

TEST_F(ViewFilmTest, ViewsMustBeOfOneKind) {
  WriteFrames<uint8_t>(1, 1);
  const ViewFilmOptions options = {ViewLayout::kSideBySide, {}, folder_ / "s.png"};
  WriteFrames<uint8_t>(2, 2, 7);
  ExpectWords(ErrorOf(options, ErrorKind::kInput),
              {"frame_0002.png: has 7 x 4 pixels", "frame_0001.png has 6 x 4 pixels"});
  WriteFrames<uint8_t>(2, 2, 6, 4, 4);
  ExpectWords(ErrorOf(options, ErrorKind::kInput), {"R G B A of", "R G B of"});
  WriteFrames<uint16_t>(2, 2, 6, 4, 3, {PixelType::kUint16, {}, {}, true});
  ExpectWords(ErrorOf(options, ErrorKind::kInput), {"16 bits", "8 bits"});
  WriteFrames<uint8_t>(2, 2, 6, 4, 3, {PixelType::kUint8, {}, {}, false});
  ExpectWords(ErrorOf(options, ErrorKind::kInput), {"of sRGB"});
  WriteFrames<float>(2, 2, 6, 4, 3, {PixelType::kHalf});
  ExpectWords(ErrorOf(options, ErrorKind::kInput), {"frame_0002", "of one format"});
}

TEST_F(ViewFilmTest, PngFilesOfExrFramesAreWhatPngFramesShow) {
  const ColourFacts colours = {PixelType::kFloat, {}, 25};
  const std::vector<std::string> names = {"R", "G", "B"};
  Image<float> linear(6, 4, 3);
  for (size_t i = 0; i < linear.pixels().size(); ++i)
    linear.pixels()[i] = -0.1f + 0.02f * static_cast<float>(i);
  for (uint32_t frame = 1; frame <= 2; ++frame) {
    ASSERT_TRUE(WriteStoredImage(FramePath(views_, FrameId{frame}, FrameFormat::kExrFloat), linear,
                                 names, colours));
    linear.pixels()[0] = 0.5f;  // the frames differ
  }
  const auto first = ReadDisplayImage(views_ / "frame_0001.exr");
  const auto second = ReadDisplayImage(views_ / "frame_0002.exr");
  ASSERT_TRUE(first && second);
  ASSERT_NE(first->at(0, 0, 0), second->at(0, 0, 0));
  ASSERT_TRUE(Write({ViewLayout::kSideBySide, {}, folder_ / "s.png"}));
  const auto joined = Read<uint8_t>("s.png");
  ASSERT_EQ(joined.channels(), 3);
  ExpectTile(joined, 0, 0, *first);
  ExpectTile(joined, 1, 0, *second);
  const auto header = ReadPictureHeader(folder_ / "s.png");
  ASSERT_TRUE(header);
  EXPECT_TRUE(header->colours.is_srgb);
  EXPECT_EQ(header->colours.frames_per_second, 25);
  ASSERT_TRUE(Write({ViewLayout::kLeftRight, {}, folder_ / "e.png"}));
  ExpectTile(Read<uint8_t>("e_left.png"), 0, 0, *first);
  ExpectTile(Read<uint8_t>("e_right.png"), 0, 0, *second);
}

TEST_F(ViewFilmTest, OutputsThatFitNothingAreRefused) {
  WriteFrames<uint8_t>(1, 2, 5, 4, 4);
  ExpectWords(ErrorOf({ViewLayout::kSideBySide, {}, folder_ / "s.exr"}, ErrorKind::kUsage),
              {"s.exr", "\".png\"", "\".mp4\""});
  ExpectWords(ErrorOf({ViewLayout::kSideBySide, {}, folder_ / "no" / "s.png"}, ErrorKind::kOutput),
              {"no does not exist"});
  ExpectWords(ErrorOf({ViewLayout::kAnaglyph, {}, folder_ / "s.png"}, ErrorKind::kInput),
              {"has alpha", "anaglyph"});
  ExpectWords(ErrorOf({ViewLayout::kAnaglyph, {}, folder_ / "s.mp4"}, ErrorKind::kInput),
              {"has alpha", "anaglyph"});
  ExpectWords(ErrorOf({ViewLayout::kSideBySide, {}, folder_ / "s.png", 25}, ErrorKind::kUsage),
              {"{fps} is for videos"});
  ExpectWords(
      ErrorOf({ViewLayout::kQuilt, {2, 1}, folder_ / "s_qs1x2a0.75.png"}, ErrorKind::kUsage),
      {"_qs1x2a0.75", "_qs2x1a1.25"});
  ExpectWords(ErrorOf({ViewLayout::kQuilt, {1, 2}, folder_ / "s.mp4"}, ErrorKind::kInput),
              {"quilt of 5 x 8", "even"});
}

TEST_F(ViewFilmTest, AnInputIsNeverReplaced) {
  WriteFrames<uint8_t>(1, 2);
  const ViewFilmOptions options = {
      .layout = ViewLayout::kAnaglyph, .output = views_ / "frame_0001.png", .overwrite = true};
  ExpectWords(ErrorOf(options, ErrorKind::kUsage), {"would be replaced", "a frame that is joined"});
}

TEST_F(ViewFilmTest, WhatExistsIsKeptOrReplacedOnDemandOnly) {
  WriteFrames<uint8_t>(1, 4);
  ViewFilmOptions options = {ViewLayout::kSideBySide, {}, folder_ / "s.png"};
  ASSERT_TRUE(Write(options));
  ExpectWords(ErrorOf(options, ErrorKind::kUsage), {"s_0001.png: exists", "{overwrite}"});
  const std::string whole = ReadFile(folder_ / "s_0001.png").value();
  fs::remove(folder_ / "s_0002.png");
  options.resume = true;
  const auto resumed = Write(options);
  ASSERT_TRUE(resumed) << resumed.error().message;
  EXPECT_EQ(resumed->kept_count, 1u);
  EXPECT_EQ(ReadFile(folder_ / "s_0001.png").value(), whole);
  EXPECT_TRUE(fs::exists(folder_ / "s_0002.png"));
  // A file that was cut is made again.
  ASSERT_TRUE(WriteFileAtomically(folder_ / "s_0001.png", whole.substr(0, whole.size() - 20)));
  ASSERT_TRUE(Write(options));
  EXPECT_EQ(ReadFile(folder_ / "s_0001.png").value(), whole);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "s_0001.png", "other"));
  ExpectWords(ErrorOf(options, ErrorKind::kUsage),
              {"s_0001.png: exists already", "does not tell", "{overwrite}"});
  options.resume = false;
  options.overwrite = true;
  ASSERT_TRUE(Write(options));
  EXPECT_EQ(ReadFile(folder_ / "s_0001.png").value(), whole);
}

TEST_F(ViewFilmTest, FilesOfOtherFramesOrLayoutsAreNotKept) {
  WriteFrames<uint8_t>(1, 4);
  const auto expect_refused = [&](ViewFilmOptions options, const ViewFilmOptions& other,
                                  const std::string& word) {
    ASSERT_TRUE(Write(options));
    options.resume = true;
    const auto same = Write(options);
    ASSERT_TRUE(same) << same.error().message;
    EXPECT_EQ(same->kept_count, same->files.size());
    ViewFilmOptions resumed = other;
    resumed.resume = true;
    ExpectWords(ErrorOf(resumed, ErrorKind::kUsage), {"exists already", word, "{overwrite}"});
  };
  for (const char* const name : {"s.png", "s.mp4"}) {
    const ViewFilmOptions one = {ViewLayout::kAnaglyph, {}, folder_ / name};
    expect_refused(one, {ViewLayout::kSideBySide, {}, folder_ / name}, "layout anaglyph");
  }
  const ViewFilmOptions slow = {ViewLayout::kAnaglyph, {}, folder_ / "f.mp4", 12};
  expect_refused(slow, {ViewLayout::kAnaglyph, {}, folder_ / "f.mp4", 24}, "fps 12");
  for (const ViewLayout layout : {ViewLayout::kSideBySide, ViewLayout::kLeftRight})
    for (const char* const name : {"o.png", "o.mp4"}) {
      const ViewFilmOptions options = {layout, {}, folder_ / (NameOf(layout) + std::string(name))};
      ASSERT_TRUE(Write(options));
    }
  ASSERT_TRUE(WriteStoredImage(FramePath(views_, FrameId{4}, FrameFormat::kPng8),
                               Picture<uint8_t>(9, 6, 4, 3), {"R", "G", "B"},
                               {PixelType::kUint8, {}, {}, true}));
  for (const ViewLayout layout : {ViewLayout::kSideBySide, ViewLayout::kLeftRight})
    for (const char* const name : {"o.png", "o.mp4"}) {
      ViewFilmOptions options = {layout, {}, folder_ / (NameOf(layout) + std::string(name))};
      options.resume = true;
      ErrorOf(options, ErrorKind::kUsage);
    }
}

TEST_F(ViewFilmTest, AnInterruptionLeavesCompleteFiles) {
  WriteFrames<uint8_t>(1, 6);
  ViewFilmOptions options = {ViewLayout::kSideBySide, {}, folder_ / "s.png"};
  size_t views = 0, most = 0;
  options.is_interrupted = [&] { return views >= 3; };
  const auto written =
      WriteViewFilm(std::vector<fs::path>{views_}, options, pool_, [&](size_t done, size_t total) {
        views = done;
        most = total;
      });
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(most, 6u);
  EXPECT_TRUE(ReadImage(folder_ / "s_0001.png"));
  EXPECT_FALSE(fs::exists(folder_ / "s_0002.png"));
  options.is_interrupted = {};
  options.resume = true;
  const auto resumed = Write(options);
  ASSERT_TRUE(resumed);
  EXPECT_EQ(resumed->kept_count, 1u);
  EXPECT_TRUE(ReadImage(folder_ / "s_0003.png"));
}

TEST_F(ViewFilmTest, ForDisplayLightOfAnyPrimariesBecomesSrgb) {
  // Pure light of each primary, in a space with the primaries of Rec. 709 in another order.
  const ColourFacts facts = {
      PixelType::kFloat,
      std::array<float, 8>{0.3f, 0.6f, 0.15f, 0.06f, 0.64f, 0.33f, 0.3127f, 0.329f}};
  Image<float> primaries(3, 1, 3);
  for (int i = 0; i < 3; ++i) primaries.at(i, 0, i) = 1;
  const fs::path file = views_ / "frame_0001.exr";
  ASSERT_TRUE(WriteStoredImage(file, primaries, {"R", "G", "B"}, facts));
  const auto header = ReadPictureHeader(file);
  const auto joined = JoinViews(std::vector<fs::path>{file}, *header,
                                {ViewLayout::kQuilt, {1, 1}, true}, pool_, {});
  ASSERT_TRUE(joined) << joined.error().message;
  const auto& picture = std::get<Image<uint8_t>>(*joined);
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(picture.at(i, 0, c), c == (i + 1) % 3 ? 255 : 0, 1) << i << " " << c;
}

TEST_F(ViewFilmTest, ATileHasItsSizeAndTheNameTheAspectOfTheViews) {
  WriteFrames<uint8_t>(1, 2, 8, 4);
  ViewFilmOptions options = {ViewLayout::kQuilt, {2, 1}, folder_ / "q.png"};
  options.tile = {4, 4};
  options.aspect = 2;
  const auto written = Write(options);
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written->width, 8);
  EXPECT_EQ(written->height, 4);
  const auto joined = Read<uint8_t>("q_qs2x1a2.00.png");
  EXPECT_EQ(joined.width(), 8);
  // The mean of two neighbours lies between them.
  const auto first = Picture<uint8_t>(1, 8, 4, 3);
  EXPECT_GT(joined.at(1, 2, 0), first.at(2, 2, 0));
  EXPECT_LT(joined.at(1, 2, 0), first.at(3, 2, 0));
  options.output = folder_ / "r.png";
  options.tile = {9, 4};
  ExpectWords(ErrorOf(options, ErrorKind::kUsage), {"8 x 4 pixels", "9 x 4", "{tile}"});
  options.tile = {4, 4};
  options.aspect = 1.5;
  ExpectWords(ErrorOf(options, ErrorKind::kUsage), {"2.000", "1.500", "{lfpath device}"});
}

}  // namespace
}  // namespace lf
