// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/stanford_name.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(StanfordName, HasRowColumnAndPosition) {
  const auto name = ParseStanfordName("out_09_16_-381.909271_1103.376221.png");
  ASSERT_TRUE(name && name->position);
  EXPECT_EQ(name->row, 9);
  EXPECT_EQ(name->column, 16);
  EXPECT_EQ(name->position->y_mm, -381.909271);
  EXPECT_EQ(name->position->x_mm, 1103.376221);
  EXPECT_FALSE(name->lens);
}

TEST(StanfordName, MayStateTheLens) {
  const auto name = ParseStanfordName("Original Camera_18_04_-153.846154_276.923077_30_36.jpg");
  ASSERT_TRUE(name && name->position);
  EXPECT_EQ(name->row, 18);
  EXPECT_EQ(name->column, 4);
  EXPECT_EQ(name->position->y_mm, -153.846154);
  EXPECT_EQ(name->position->x_mm, 276.923077);
  ASSERT_TRUE(name->lens);
  EXPECT_EQ(name->lens->focal_mm, 30);
  EXPECT_EQ(name->lens->sensor_width_mm, 36);
}

TEST(StanfordName, MayEndInAnUnderscoreAndContainSome) {
  const auto name = ParseStanfordName("my_2nd_scene_00_01_-780.1_-3355.3_.PNG");
  ASSERT_TRUE(name && name->position);
  EXPECT_EQ(name->row, 0);
  EXPECT_EQ(name->column, 1);
  EXPECT_EQ(name->position->x_mm, -3355.3);
  EXPECT_FALSE(name->lens);
}

TEST(StanfordName, MayTellRowAndColumnAlone) {
  for (const char* file_name : {"out_07_12.jpg", "out_07_12_.jpg", "my_2nd_scene_7_12.png"}) {
    const auto name = ParseStanfordName(file_name);
    ASSERT_TRUE(name) << file_name;
    EXPECT_EQ(name->row, 7);
    EXPECT_EQ(name->column, 12);
    EXPECT_FALSE(name->position);
    EXPECT_FALSE(name->lens);
  }
}

TEST(StanfordName, MayLackTheNameBeforeTheNumbers) {
  for (const char* file_name : {"007_012.png", "07_12_.png", "7_12_2.5_3.0.png", "_7_12.png"}) {
    const auto name = ParseStanfordName(file_name);
    ASSERT_TRUE(name) << file_name;
    EXPECT_EQ(name->row, 7);
    EXPECT_EQ(name->column, 12);
  }
  const auto with_lens = ParseStanfordName("07_12_2.5_3.0_30_36.png");
  ASSERT_TRUE(with_lens && with_lens->lens);
  EXPECT_EQ(with_lens->row, 7);
}

TEST(StanfordName, MayMarkRowAndColumn) {
  for (const char* file_name :
       {"view_r7_c12.png", "r07_c12.jpg", "NAME_R7_C12.ppm", "a_row7_col12.png", "r7c12.png",
        "x-r007-c012.png", "lf-7-12.png", "007-012.png", "Cam(7,12).png", "Cam (7, 12).png"}) {
    const auto name = ParseStanfordName(file_name);
    ASSERT_TRUE(name) << file_name;
    EXPECT_EQ(name->row, 7) << file_name;
    EXPECT_EQ(name->column, 12) << file_name;
    EXPECT_FALSE(name->position);
  }
  for (const char* file_name :
       {"doctor7_c12.png", "pic12.png", "r7_c.png", "lf7-12.png", "(7,12.png", "7,12).png",
        "(7,).png", "r7_x12.png", "-12.png", "r_c12.png"})
    EXPECT_FALSE(ParseStanfordName(file_name)) << file_name;
}

TEST(StanfordName, TheBenchmarkNumbersItsCameras) {
  EXPECT_EQ(NumberOfHciName("input_Cam000.png"), 0);
  EXPECT_EQ(NumberOfHciName("input_Cam123.jpg"), 123);
  for (const char* name :
       {"input_Cam.png", "input_Cam000.txt", "input_Cam-01.png", "input_Cam0x1.png", "Cam000.png",
        "input_Cam99999999999.png", "input_Cam"})
    EXPECT_EQ(NumberOfHciName(name), std::nullopt) << name;
}

TEST(StanfordName, OtherNamesHaveNone) {
  for (const char* name : {"",
                           ".",
                           "_",
                           "____.png",
                           ".png",
                           "a.png",
                           "out_00.png",
                           "out_00_1.0.png",
                           "out_00_-1.png",
                           "out_99999999999_01.png",
                           "_01.png",
                           "01.png",
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

}  // namespace
}  // namespace lf
