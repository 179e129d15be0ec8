#include "lf/capture/read_stanford.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/imageio/image_file.h"
#include "lf/imageio/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

TEST(StanfordName, HasRowColumnAndPosition) {
  const auto name = ParseStanfordName("out_09_16_-381.909271_1103.376221.png");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->row, 9);
  EXPECT_EQ(name->column, 16);
  EXPECT_EQ(name->y_mm, -381.909271);
  EXPECT_EQ(name->x_mm, 1103.376221);
  EXPECT_FALSE(name->lens);
}

TEST(StanfordName, MayStateTheLens) {
  const auto name = ParseStanfordName("Original Camera_18_04_-153.846154_276.923077_30_36.jpg");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->row, 18);
  EXPECT_EQ(name->column, 4);
  EXPECT_EQ(name->y_mm, -153.846154);
  EXPECT_EQ(name->x_mm, 276.923077);
  ASSERT_TRUE(name->lens);
  EXPECT_EQ(name->lens->focal_mm, 30);
  EXPECT_EQ(name->lens->sensor_width_mm, 36);
}

TEST(StanfordName, MayEndInAnUnderscoreAndContainSome) {
  const auto name = ParseStanfordName("my_2nd_scene_00_01_-780.1_-3355.3_.PNG");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->row, 0);
  EXPECT_EQ(name->column, 1);
  EXPECT_EQ(name->x_mm, -3355.3);
  EXPECT_FALSE(name->lens);
}

TEST(StanfordName, OtherNamesHaveNone) {
  for (const char* name : {"",
                           ".",
                           "_",
                           "____.png",
                           ".png",
                           "a.png",
                           "out_00_01.png",
                           "out_00_01_2.png",
                           "00_01_2.0_3.0.png",
                           "out_00_01_2.0_3.0",
                           "out_00_01_2.0_3.0.txt",
                           "out_-1_01_2.0_3.0.png",
                           "out_0x1_01_2.0_3.0.png",
                           "out_1.5_01_2.0_3.0.png",
                           "out_00_01_nan_3.0.png",
                           "out_00_01_inf_3.0.png",
                           "out_00_01_1e3_3.0.png",
                           "out_00_01_-_3.0.png",
                           "out_00_01_--1_3.0.png",
                           "out_00_01_1.2.3_3.0.png",
                           "out_00_01__3.0.png",
                           "out_99999999999_01_2.0_3.0.png",
                           "out_00_01_9999999999999_3.0.png",
                           "out_00_01_2.0_3.0_30.png"})
    EXPECT_FALSE(ParseStanfordName(name)) << name;
}

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

TEST_F(StanfordFolderTest, OtherFilesAreLeftOutWithAWarning) {
  AddImage("s_01_10_-5.0_-25.0_30_36.png");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "config.cfg", "x"));
  ASSERT_TRUE(WriteFileAtomically(folder_ / ".hidden", "x"));
  testing::internal::CaptureStderr();
  const Result<LightField> light_field = ReadStanfordFolder(folder_);
  const std::string warning = testing::internal::GetCapturedStderr();
  ASSERT_TRUE(light_field);
  EXPECT_EQ(light_field->size(), 1u);
  EXPECT_NE(warning.find("1 of 2 files left out"), std::string::npos) << warning;
  EXPECT_NE(warning.find(": config.cfg\n"), std::string::npos) << warning;
}

TEST_F(StanfordFolderTest, WithoutAFocalLengthSaysWhatIsMissing) {
  AddImage("s_01_10_-5.0_-25.0.png");
  EXPECT_NE(Error().find("s_01_10_-5.0_-25.0.png has no _FOCALMM_SENSORMM"), std::string::npos);
  const Result<LightField> light_field = ReadStanfordFolder(folder_, 100);
  ASSERT_TRUE(light_field);
  EXPECT_EQ(light_field->intrinsics[0], (Intrinsics{100, 100, 18, 10, 0, 36, 20}));
  AddImage("s_01_11_-5.0_-25.0_30_36.png");
  EXPECT_NE(Error().find("rename them alike"), std::string::npos);
}

TEST_F(StanfordFolderTest, UnclearFoldersAreErrors) {
  EXPECT_NE(Error().find("holds no image named NAME_ROW_COL_Y_X"), std::string::npos);
  AddImage("a_01_10_-5.0_-25.0_30_36.png");
  AddImage("b_1_10_-5.0_-25.0_30_36.png");
  EXPECT_NE(Error().find("row 1, column 10 is there twice"), std::string::npos);
}

TEST_F(StanfordFolderTest, ABrokenFirstImageIsNamed) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a_01_10_-5.0_-25.0_30_36.png", "no picture"));
  EXPECT_NE(Error().find("a_01_10_-5.0_-25.0_30_36.png"), std::string::npos);
  EXPECT_FALSE(ReadStanfordFolder(folder_ / "none"));
}

TEST_F(StanfordFolderTest, AFocalLengthOutOfRangeIsAnError) {
  AddImage("a_01_10_-5.0_-25.0_999999999_0.1.png");
  EXPECT_NE(Error().find("focal length comes to"), std::string::npos);
}

}  // namespace
}  // namespace lf
