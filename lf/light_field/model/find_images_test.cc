// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/find_images.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

class FindImagesTest : public FolderTest {
 protected:
  void WriteImages(std::initializer_list<const char*> names, int width = 8, int height = 6) {
    for (const char* name : names) {
      fs::create_directories((folder_ / name).parent_path());
      ASSERT_TRUE(WriteImage(folder_ / name, Image<uint8_t>(width, height, 3).view())) << name;
    }
  }
  LightField FieldOf(std::vector<std::string> names) const {
    LightField field;
    field.folder = folder_;
    field.cameras.resize(names.size());
    field.intrinsics = {{8, 8, 4, 3, 0, 8, 6}};
    field.image_names = std::move(names);
    return field;
  }
};

TEST_F(FindImagesTest, NamesThatLeadToAFileStay) {
  WriteImages({"images/a.png", "elsewhere/b.png"});
  LightField field = FieldOf({"images/a.png", "images/b.png"});
  EXPECT_EQ(*FindImageFiles({}, &field), 0u);  // one missing file is not a capture that was moved
  EXPECT_EQ(field.image_names[1], "images/b.png");
}

TEST_F(FindImagesTest, StalePathsAndSuffixesAreFoundByBaseName) {
  WriteImages({"photos/IMG_1.JPG", "photos/IMG_2.JPG"});
  LightField field =
      FieldOf({"/home/someone/scene/images/img_1.jpeg", "C:\\scene\\images\\img_2.jpeg", "img_3"});
  EXPECT_EQ(*FindImageFiles({}, &field), 2u);
  EXPECT_EQ(field.image_names,
            (std::vector<std::string>{"photos/IMG_1.JPG", "photos/IMG_2.JPG", "img_3"}));
  EXPECT_EQ(field.folder, folder_);
}

TEST_F(FindImagesTest, TheEndsOfPathsLeadToFilesBesideTheCalibration) {
  WriteImages({"images/1.png", "images/2.png", "masks/1.png", "3.png"});
  for (const char* const begin : {"..\\", "C:\\scans\\", "/home/someone/scans/"}) {
    LightField field =
        FieldOf({std::string(begin) + "images\\1.png", std::string(begin) + "images\\2.png",
                 std::string(begin) + "images\\4.png"});
    field.folder = folder_ / "calibration";
    fs::create_directories(field.folder);
    field.mask_names = {std::string(begin) + "masks\\1.png", "", ""};
    EXPECT_EQ(*FindImageFiles({}, &field), 2u) << begin;
    EXPECT_TRUE(fs::exists(field.ImagePath({0}))) << field.ImagePath({0});
    EXPECT_TRUE(fs::exists(field.folder / field.mask_names[0])) << field.mask_names[0];
    EXPECT_EQ(fs::path(field.image_names[2]).filename(), "4.png");
  }
  LightField other = FieldOf({"/home/someone/3.png"});  // a base name alone says too little
  other.folder = folder_ / "calibration";
  EXPECT_EQ(*FindImageFiles({}, &other), 0u);
}

TEST_F(FindImagesTest, NamesThatLookAlikeAreFound) {
  WriteImages({"photos/Ku\u0308che 1.png", "photos/\u00c4 2.PNG"});
  LightField field = FieldOf({"images/K\u00fcche 1.png", "images/A\u0308 2.jpg"});
  EXPECT_EQ(*FindImageFiles({}, &field), 2u);
  EXPECT_EQ(field.image_names,
            (std::vector<std::string>{"photos/Ku\u0308che 1.png", "photos/\u00c4 2.PNG"}));
}

TEST_F(FindImagesTest, DatesBeforeNamesMatterOnlyIfNoFileHasTheName) {
  WriteImages({"p/2021-05-04_img1.png", "p/img2.png", "p/2021-05-04_img2.png", "p/img3.png"});
  LightField field = FieldOf({"i/img1.png", "i/img2.png", "i/20210504_123001-img3.png"});
  EXPECT_EQ(*FindImageFiles({}, &field), 3u);
  EXPECT_EQ(field.image_names,
            (std::vector<std::string>{"p/2021-05-04_img1.png", "p/img2.png", "p/img3.png"}));
}

TEST_F(FindImagesTest, FoldersInCommonDecide) {
  WriteImages({"left/1.png", "right/1.png"});
  LightField field = FieldOf({"/gone/rig/right/1.png", "/gone/rig/left/1.png"});
  EXPECT_EQ(*FindImageFiles({}, &field), 2u);
  EXPECT_EQ(field.image_names, (std::vector<std::string>{"right/1.png", "left/1.png"}));
}

TEST_F(FindImagesTest, TheLargestPicturesAreTaken) {
  WriteImages({"images_4/1.png"}, 4, 3);
  WriteImages({"images_2/1.png"}, 8, 6);
  WriteImages({"images_8/1.png"}, 2, 2);
  LightField field = FieldOf({"images/1.jpg"});
  EXPECT_EQ(*FindImageFiles({}, &field), 1u);
  EXPECT_EQ(field.image_names[0], "images_2/1.png");
}

TEST_F(FindImagesTest, MasksAreNotTakenForPhotographs) {
  WriteImages({"masks/1.png", "depth/1.png"});
  LightField field = FieldOf({"images/1.png"});
  EXPECT_EQ(*FindImageFiles({}, &field), 0u);
  EXPECT_EQ(field.image_names[0], "images/1.png");
}

TEST_F(FindImagesTest, MasksOfMovedImagesAreFoundInTheirFolder) {
  WriteImages({"photos/1.jpg", "photos/2.jpg", "my/masks/1.png"});
  LightField field = FieldOf({"/gone/images/1.jpg", "/gone/images/2.jpg"});
  field.mask_names = {"/gone/masks/1.png", "/gone/masks/2.png"};
  EXPECT_EQ(*FindImageFiles({}, &field), 2u);
  EXPECT_EQ(field.mask_names, (std::vector<std::string>{"my/masks/1.png", "/gone/masks/2.png"}));
}

TEST_F(FindImagesTest, TwoThatFitAlikeAreAnError) {
  WriteImages({"b/1.png", "a/1.png"});
  LightField field = FieldOf({"images/1.png"});
  const auto found = FindImageFiles({}, &field);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, ErrorKind::kInput);
  for (const char* word : {"a/1.png", "b/1.png", "{images}", "1 of 1"})
    EXPECT_NE(found.error().message.find(word), std::string::npos) << found.error().message;
}

TEST_F(FindImagesTest, ANamedFolderIsTheOnlyOne) {
  WriteImages({"images/1.png", "other/x/1.jpg"});
  LightField field = FieldOf({"images/1.png"});
  EXPECT_EQ(*FindImageFiles(folder_ / "other", &field), 1u);
  EXPECT_EQ(field.ImagePath({0}), folder_ / "other/x/1.jpg");
  EXPECT_EQ(*FindImageFiles(folder_ / "nowhere", &field), 0u);
}

TEST_F(FindImagesTest, WholeFactorsScaleTheIntrinsics) {
  // COLMAP rounds 1006 / 4 x 755 / 4 to the nearest pixel, nerfstudio rounds it down.
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{252, 189}, {251, 188}}) {
    LightField field = FieldOf({"1.png"});
    field.intrinsics = {{900, 902, 503, 377.5, 0, 1006, 755}};
    WriteImages({"1.png"}, width, height);
    const auto factor = FitToImageFiles({}, &field);
    ASSERT_TRUE(factor) << factor.error().message;
    EXPECT_EQ(*factor, 0.25);
    const Intrinsics& k = field.intrinsics[0];
    EXPECT_EQ(k.width_px, width);
    EXPECT_EQ(k.height_px, height);
    // The picture still covers the same field of view from edge to edge.
    EXPECT_NEAR(k.fx_px / k.width_px, 900.0 / 1006, 1e-12);
    EXPECT_NEAR(k.fy_px / k.height_px, 902.0 / 755, 1e-12);
    EXPECT_NEAR(k.cx_px, 0.5 * width, 1e-12);
    EXPECT_NEAR(k.cy_px, 0.5 * height, 1e-12);
  }
}

TEST_F(FindImagesTest, OtherSizesAreLeftAlone) {
  // Half of the calibrated 1000 x 1000 pixels, the same cropped by undistortion, half of the width
  // only, and twice the size.
  const std::vector<std::pair<int, int>> sizes = {
      {500, 500}, {494, 494}, {500, 1000}, {2000, 2000}};
  for (const auto& [width, height] : sizes) {
    LightField field = FieldOf({"1.png", "2.png"});
    field.intrinsics = {{900, 900, 500, 500, 0, 1000, 1000}};
    WriteImages({"1.png"}, 1000, 1000);
    WriteImages({"2.png"}, width, height);
    EXPECT_EQ(*FitToImageFiles({}, &field), 1);  // no common factor
    WriteImages({"1.png"}, width, height);
    EXPECT_EQ(*FitToImageFiles({}, &field), width == 500 && height == 500 ? 0.5 : 1);
  }
  LightField field = FieldOf({"1.png"});
  field.intrinsics = {{900, 900, 500, 500, 0, 1000, 1000}};
  WriteImages({"1.png"}, 500, 500);
  EXPECT_EQ(*FitToImageFiles({ImageScale::Kind::kOff}, &field), 1);
  fs::remove(folder_ / "1.png");
  EXPECT_EQ(*FitToImageFiles({}, &field), 1);  // no file exists
}

TEST_F(FindImagesTest, AGivenFactorMustBeThatOfTheFiles) {
  LightField field = FieldOf({"1.png"});
  field.intrinsics = {{900, 900, 500, 500, 0, 1000, 1000}};
  WriteImages({"1.png"}, 750, 750);
  EXPECT_EQ(*FitToImageFiles({}, &field), 1);
  const auto wrong = FitToImageFiles(*ParseImageScale("0.5"), &field);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("750 x 750"), std::string::npos);
  EXPECT_NEAR(*FitToImageFiles(*ParseImageScale("0.75"), &field), 0.75, 1e-12);
  EXPECT_EQ(field.intrinsics[0].fx_px, 675);
}

TEST_F(FindImagesTest, ScalesAreRead) {
  EXPECT_EQ(ParseImageScale("auto")->kind, ImageScale::Kind::kAuto);
  EXPECT_EQ(ParseImageScale("off")->kind, ImageScale::Kind::kOff);
  EXPECT_EQ(ParseImageScale("0.25")->factor, 0.25);
  for (const char* wrong : {"", "0", "-1", "1/4", "0.5x", "inf", "nan"})
    EXPECT_FALSE(ParseImageScale(wrong)) << wrong;
}

}  // namespace
}  // namespace lf
