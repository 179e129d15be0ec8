// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_splits.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "lf/core/file.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class ReadSplitsTest : public FolderTest {
 protected:
  // Writes a part of a data set in Blender's form, with one image for each x of a camera's
  // position.
  void Write(const std::string& part, const std::vector<int>& xs, const std::string& keys = "") {
    std::string frames;
    fs::create_directories(folder_ / part);
    for (const int x : xs) {
      frames += fmt::format(
          R"({}{{"file_path": "./{}/r_{}", "transform_matrix": [[1,0,0,{}],[0,1,0,0],[0,0,1,0]]}})",
          frames.empty() ? "" : ", ", part, x, x);
      const fs::path image = folder_ / part / fmt::format("r_{}.png", x);
      ASSERT_TRUE(WriteImage(image, Image<uint8_t>(8, 6, 3).view()));
    }
    ASSERT_TRUE(WriteFileAtomically(
        folder_ / fmt::format("transforms_{}.json", part),
        fmt::format(R"({{"camera_angle_x": 0.7, {}"frames": [{}]}})", keys, frames)));
  }
};

TEST_F(ReadSplitsTest, ThePartsAreOneLightField) {
  Write("test", {3, 1});
  Write("train", {0, 1, 1});  // two exposures of one pose stay
  EXPECT_TRUE(HoldsLightField(folder_));
  testing::internal::CaptureStderr();
  const Result<LightField> light_field = OpenLightField(folder_);
  const std::string log = testing::internal::GetCapturedStderr();
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names,
            (std::vector<std::string>{"./train/r_0.png", "./train/r_1.png", "./train/r_1.png",
                                      "./test/r_3.png"}));
  EXPECT_EQ(light_field->intrinsics.size(), 1u);
  EXPECT_EQ(light_field->Camera({3}).CentreWorld(), Vec3(3, 0, 0));
  EXPECT_NE(log.find("transforms_train.json, transforms_test.json are read as one light field of 4 "
                     "LF images, without 1 whose pose another file has"),
            std::string::npos)
      << log;
}

TEST_F(ReadSplitsTest, EachPartMayBeReadAlone) {
  Write("train", {0, 1});
  Write("val", {2});
  EXPECT_EQ(OpenLightField(folder_ / "transforms_val.json")->size(), 1u);
  EXPECT_EQ(SplitsIn(folder_).size(), 2u);
  EXPECT_EQ(SplitsIn(folder_ / "train").size(), 0u);
}

TEST_F(ReadSplitsTest, PartsThatDisagreeAreAnError) {
  Write("train", {0, 1});
  Write("val", {2}, R"("lf_unit_m": 0.5, )");
  const Result<LightField> light_field = OpenLightField(folder_);
  ASSERT_FALSE(light_field);
  EXPECT_EQ(light_field.error().kind, ErrorKind::kInput);
  EXPECT_NE(light_field.error().message.find("transforms_val.json: states another encoding"),
            std::string::npos);
}

TEST_F(ReadSplitsTest, MovedImagesAreFoundBeforeTheirSizeIsAsked) {
  Write("train", {0, 1});
  Write("test", {2});
  fs::create_directories(folder_ / "photos");
  fs::rename(folder_ / "train", folder_ / "photos" / "train");
  const Result<LightField> light_field = OpenLightField(folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  for (uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(fs::exists(light_field->ImagePath({i}))) << i;
}

}  // namespace
}  // namespace lf
