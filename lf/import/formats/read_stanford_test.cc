// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_stanford.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class StanfordFolderTest : public FolderTest {
 protected:
  void AddImage(const std::string& name) const {
    const Image<uint8_t> image(36, 20, 3);
    ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
  }
  std::string Error() const {
    const Result<LightField> light_field = ReadStanfordFolder(folder_);
    EXPECT_FALSE(light_field);
    return light_field ? "" : light_field.error().message;
  }
};

TEST_F(StanfordFolderTest, GivesParallelCamerasByRowAndColumn) {
  AddImage("s_01_10_-5.0_-25.0_30_36.png");
  AddImage("s_01_02_-5.0_125.0_30_36.png");
  AddImage("s_00_03_5.0_25.0_60_36.png");
  const Result<LightField> light_field = ReadStanfordFolder(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names,
            (std::vector<std::string>{"s_00_03_5.0_25.0_60_36.png", "s_01_02_-5.0_125.0_30_36.png",
                                      "s_01_10_-5.0_-25.0_30_36.png"}));
  EXPECT_EQ(light_field->Camera({0}).CentreWorld(), Vec3(0.025, 0.005, 0));
  EXPECT_EQ(light_field->Camera({1}).CentreWorld(), Vec3(0.125, -0.005, 0));
  EXPECT_EQ(light_field->Camera({2}).CentreWorld(), Vec3(-0.025, -0.005, 0));
  EXPECT_EQ(light_field->Camera({0}).intrinsics, (Intrinsics{60, 60, 18, 10, 0, 36, 20}));
  EXPECT_EQ(light_field->Camera({1}).intrinsics, (Intrinsics{30, 30, 18, 10, 0, 36, 20}));
  EXPECT_EQ(light_field->intrinsics.size(), 2u);
  for (uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(light_field->cameras[i].cam_from_world.rotation, Mat3::Identity());
    EXPECT_TRUE(fs::exists(light_field->ImagePath({i})));
  }
  EXPECT_EQ(light_field->unit_m, 1);
}

TEST_F(StanfordFolderTest, TheAxisOfAnOddImageIsTheMiddleOfAPixel) {
  const std::string name = "s_00_00_0_0_30_36.png";
  ASSERT_TRUE(WriteImage(folder_ / name, Image<uint8_t>(37, 21, 3).view()));
  const Result<LightField> light_field = ReadStanfordFolder(folder_, {.plane_distance_w = 2});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->intrinsics[0].cx_px, 18.5);
  EXPECT_EQ(light_field->intrinsics[0].cy_px, 10.5);
}

TEST_F(StanfordFolderTest, AGridOrdersImagesOfAnyNames) {
  for (const char* name : {"a 1.png", "a 2.png", "a 9.png", "a 10.png", "a 11.png", "b.png"})
    AddImage(name);
  StanfordOptions options = {.grid = std::array{3, 2}, .focal_px = 30, .pitch_w = Vec2(1, 2)};
  const auto centres_of = [&] {
    const Result<LightField> light_field = ReadStanfordFolder(folder_, options);
    EXPECT_TRUE(light_field) << light_field.error().message;
    std::map<std::string, Vec3> centres;
    for (uint32_t i = 0; light_field && i < light_field->size(); ++i)
      centres[light_field->image_names[i]] = light_field->Camera({i}).CentreWorld();
    return centres;
  };
  std::map<std::string, Vec3> centres = centres_of();
  EXPECT_EQ(centres["a 1.png"], Vec3(-1, -1, 0));
  EXPECT_EQ(centres["a 9.png"], Vec3(1, -1, 0));
  EXPECT_EQ(centres["a 10.png"], Vec3(-1, 1, 0));
  EXPECT_EQ(centres["b.png"], Vec3(1, 1, 0));
  options.is_serpentine = true;
  centres = centres_of();
  EXPECT_EQ(centres["a 9.png"], Vec3(1, -1, 0));
  EXPECT_EQ(centres["a 10.png"], Vec3(1, 1, 0));
  EXPECT_EQ(centres["b.png"], Vec3(-1, 1, 0));
  options.grid = std::array{3, 3};
  EXPECT_NE(ReadStanfordFolder(folder_, options).error().message.find("holds 6 images"),
            std::string::npos);
  options.grid = std::array{0, 6};
  EXPECT_EQ(ReadStanfordFolder(folder_, options).error().kind, ErrorKind::kUsage);
}

TEST_F(StanfordFolderTest, OtherFilesAreLeftOutWithAWarning) {
  AddImage("s_01_10_-5.0_-25.0_30_36.png");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "config.cfg", "x"));
  ASSERT_TRUE(WriteFileAtomically(folder_ / ".hidden", "x"));
  testing::internal::CaptureStderr();
  const Result<LightField> light_field = ReadStanfordFolder(folder_);
  const std::string warning = testing::internal::GetCapturedStderr();
  ASSERT_TRUE(light_field);
  EXPECT_EQ(light_field->size(), 1u);
  EXPECT_NE(warning.find("1 of 2 files are left out"), std::string::npos) << warning;
  EXPECT_NE(warning.find(": config.cfg\n"), std::string::npos) << warning;
}

TEST_F(StanfordFolderTest, WithoutAFocalLengthSaysWhatIsMissing) {
  AddImage("s_01_10_-5.0_-25.0.png");
  EXPECT_NE(Error().find("s_01_10_-5.0_-25.0.png has no _FOCALMM_SENSORMM"), std::string::npos);
  const Result<LightField> light_field = ReadStanfordFolder(folder_, {.focal_px = 100});
  ASSERT_TRUE(light_field);
  EXPECT_EQ(light_field->intrinsics[0], (Intrinsics{100, 100, 18, 10, 0, 36, 20}));
  EXPECT_NE(Error().find(" -o " + folder_.string() + " --focal-px 36 --plane-distance 100"),
            std::string::npos);
  AddImage("s_01_11_-5.0_-25.0_30_36.png");
  EXPECT_NE(Error().find("rename all files"), std::string::npos);
}

TEST_F(StanfordFolderTest, APitchPlacesRowsAndColumnsAroundTheMiddle) {
  for (const char* name : {"out_02_04.png", "out_02_08.png", "out_05_04.png", "out_05_08.png"})
    AddImage(name);
  const Result<LightField> light_field =
      ReadStanfordFolder(folder_, {.focal_px = 90, .pitch_w = Vec2(0.5, 2)});
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 4u);
  EXPECT_EQ(light_field->Camera({0}).CentreWorld(), Vec3(-1, -3, 0));
  EXPECT_EQ(light_field->Camera({1}).CentreWorld(), Vec3(1, -3, 0));
  EXPECT_EQ(light_field->Camera({2}).CentreWorld(), Vec3(-1, 3, 0));
  EXPECT_EQ(light_field->intrinsics, (std::vector<Intrinsics>{{90, 90, 18, 10, 0, 36, 20}}));
  const Result<LightField> flipped = ReadStanfordFolder(
      folder_, {.focal_px = 90, .pitch_w = Vec2(0.5, 2), .flip_x = true, .flip_y = true});
  ASSERT_TRUE(flipped);
  EXPECT_EQ(flipped->Camera({0}).CentreWorld(), Vec3(1, 3, 0));
  EXPECT_EQ(flipped->Camera({1}).CentreWorld(), Vec3(-1, 3, 0));
}

TEST_F(StanfordFolderTest, ARectifiedPlaneHasNoDisparity) {
  for (const char* name : {"a_00_00_100_-300.png", "a_00_01_100_500.png", "a_01_00_-700_-300.png"})
    AddImage(name);
  for (const bool flip : {false, true}) {
    const Result<LightField> light_field = ReadStanfordFolder(
        folder_, {.focal_px = 90, .plane_distance_w = 8, .flip_x = flip, .flip_y = flip});
    ASSERT_TRUE(light_field) << light_field.error().message;
    EXPECT_EQ(light_field->intrinsics.size(), 3u);
    const double sign = flip ? -1 : 1;
    EXPECT_EQ(light_field->Camera({0}).CentreWorld(), Vec3(-0.3, 0.1, 0) * sign);
    // The camera is (-0.4, 0.4) away from the middle of the grid, which is (0.1, -0.3).
    EXPECT_NEAR(light_field->Camera({0}).intrinsics.cx_px, 18 - sign * 90 * 0.4 / 8, 1e-12);
    EXPECT_NEAR(light_field->Camera({0}).intrinsics.cy_px, 10 + sign * 90 * 0.4 / 8, 1e-12);
    // This point is in the plane without disparity: all images show it at the same pixel.
    const Vec3 point(0.7, 0.2, 8);
    for (uint32_t i = 0; i < 3; ++i)
      EXPECT_LT(
          (*Project(light_field->Camera({i}), point) - *Project(light_field->Camera({0}), point))
              .norm(),
          1e-12);
  }
}

TEST_F(StanfordFolderTest, WithoutPositionsNamesTheCallThatAddsThem) {
  AddImage("out_02_04.png");
  const std::string call = fmt::format(
      "lfimport {0} -o {0} --pitch 1 --focal-px 36 --plane-distance 100", folder_.string());
  EXPECT_TRUE(Error().ends_with(call)) << Error();
  const Result<LightField> asked = ReadStanfordFolder(folder_, {.asked_for = "my field's"});
  EXPECT_TRUE(asked.error().message.ends_with(
      R"(lfimport 'my field'\''s' -o 'my field'\''s' --pitch 1 --focal-px 36 --plane-distance 100)"))
      << asked.error().message;
  const Result<LightField> no_lens = ReadStanfordFolder(folder_, {.pitch_w = Vec2(1, 1)});
  EXPECT_NE(no_lens.error().message.find("lack the focal length"), std::string::npos);
  EXPECT_TRUE(no_lens.error().message.ends_with(call)) << no_lens.error().message;
}

TEST_F(StanfordFolderTest, RowsAndColumnsOfAGridAreToldFromNumbersOfASeries) {
  EXPECT_EQ(FindStanfordNames(folder_ / "none"), StanfordNames::kNone);
  AddImage("IMG_4831_0.png");
  AddImage("IMG_4831_1.png");
  EXPECT_EQ(FindStanfordNames(folder_), StanfordNames::kSeries);
  AddImage("IMG_4832_2.png");
  AddImage("IMG_4832_3.png");
  EXPECT_EQ(FindStanfordNames(folder_), StanfordNames::kSeries);  // half of 2 x 4 places
  AddImage("IMG_4832_1.png");
  EXPECT_EQ(FindStanfordNames(folder_), StanfordNames::kGrid);  // with one hole, and counted anyhow
}

TEST_F(StanfordFolderTest, ASingleRowIsCountedFromItsBeginning) {
  for (const char* name : {"00_00.png", "00_01.png", "00_02.png"}) AddImage(name);
  EXPECT_EQ(FindStanfordNames(folder_), StanfordNames::kGrid);
  const Result<LightField> light_field =
      ReadStanfordFolder(folder_, {.focal_px = 90, .pitch_w = Vec2(1, 1)});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->Camera({2}).CentreWorld(), Vec3(1, 0, 0));
}

TEST_F(StanfordFolderTest, NumberedCamerasOfTheBenchmarkFillASquare) {
  for (int i = 0; i < 9; ++i) AddImage(fmt::format("input_Cam{:03}.png", i));
  EXPECT_EQ(FindStanfordNames(folder_), StanfordNames::kGrid);
  const Result<LightField> light_field =
      ReadStanfordFolder(folder_, {.focal_px = 90, .pitch_w = Vec2(1, 1)});
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 9u);
  EXPECT_EQ(light_field->Camera({5}).CentreWorld(), Vec3(1, 0, 0));
  EXPECT_EQ(light_field->Camera({6}).CentreWorld(), Vec3(-1, 1, 0));
  fs::remove(folder_ / "input_Cam004.png");
  EXPECT_EQ(FindStanfordNames(folder_), StanfordNames::kNone);
}

TEST_F(StanfordFolderTest, BesidePositionsRowAndColumnAreNoCamera) {
  AddImage("s_01_10_-5.0_-25.0_30_36.png");
  AddImage("sheet_01_10.png");
  testing::internal::CaptureStderr();
  const Result<LightField> light_field = ReadStanfordFolder(folder_);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("sheet_01_10.png"), std::string::npos);
  ASSERT_TRUE(light_field);
  EXPECT_EQ(light_field->size(), 1u);
}

TEST_F(StanfordFolderTest, LengthsAreAboveZero) {
  AddImage("out_02_04.png");
  for (const StanfordOptions& options :
       {StanfordOptions{.focal_px = 9, .pitch_w = Vec2(0, 1)},
        StanfordOptions{.focal_px = 9, .pitch_w = Vec2(1, -1)},
        StanfordOptions{.focal_px = 9, .pitch_w = Vec2(1, 1), .plane_distance_w = 0}}) {
    const Result<LightField> light_field = ReadStanfordFolder(folder_, options);
    ASSERT_FALSE(light_field);
    EXPECT_EQ(light_field.error().kind, ErrorKind::kUsage);
  }
}

TEST_F(StanfordFolderTest, UnclearFoldersAreErrors) {
  EXPECT_NE(Error().find("holds no image whose name has the form NAME_ROW_COL_Y_X"),
            std::string::npos);
  AddImage("a_01_10_-5.0_-25.0_30_36.png");
  AddImage("b_1_10_-5.0_-25.0_30_36.png");
  EXPECT_NE(Error().find("two images have the row 1 and column 10"), std::string::npos);
}

TEST_F(StanfordFolderTest, ABrokenFirstImageIsNamed) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a_01_10_-5.0_-25.0_30_36.png", "no picture"));
  EXPECT_NE(Error().find("a_01_10_-5.0_-25.0_30_36.png"), std::string::npos);
  EXPECT_FALSE(ReadStanfordFolder(folder_ / "none"));
}

TEST_F(StanfordFolderTest, AFocalLengthOutOfRangeIsAnError) {
  AddImage("a_01_10_-5.0_-25.0_999999999_0.1.png");
  EXPECT_NE(Error().find("computed focal length is"), std::string::npos);
}

}  // namespace
}  // namespace lf
