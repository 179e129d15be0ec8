// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/picture_grid.h"

#include <gtest/gtest.h>

#include "lf/core/file.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

using PictureGridTest = FolderTest;

TEST(PictureGrid, IsStatedByTheNamesOfQuiltsAndOfTheLytroArchive) {
  const auto quilt = PictureGridOfName("my scene_qs8x6a0.75.PNG");
  ASSERT_TRUE(quilt);
  EXPECT_EQ(quilt->layout, PictureLayout::kQuilt);
  EXPECT_EQ(quilt->grid, (std::array{8, 6}));
  EXPECT_EQ(quilt->aspect, 0.75);
  EXPECT_FALSE(PictureGridOfName("a_QS5x9.jpg")->aspect);
  const auto lenslets = PictureGridOfName("IMG_0001_eslf.png");
  ASSERT_TRUE(lenslets);
  EXPECT_EQ(lenslets->layout, PictureLayout::kLenslets);
  EXPECT_EQ(lenslets->grid, (std::array{14, 14}));
  for (const char* name :
       {"a.png", "a_5x5.png", "a_qs.png", "a_qs5.png", "a_qs5x.png", "a_qs0x5.png", "a_qs5x5b.png",
        "a_qs5x5a.png", "a_qs5x5a0.png", "a_qs5x5.txt", "eslf.png"})
    EXPECT_FALSE(PictureGridOfName(name)) << name;
}

TEST(PictureGrid, PixelsOfQuiltsMayNotBeSquare) {
  PictureGrid grid = {.layout = PictureLayout::kQuilt, .grid = {5, 9}};
  EXPECT_EQ(PixelAspect(grid, 512, 682), 1);
  grid.aspect = 0.75;
  EXPECT_EQ(PixelAspect(grid, 512, 682), 1) << "but for rounding";
  EXPECT_EQ(PixelAspect(grid, 300, 300), 0.75);
}

TEST_F(PictureGridTest, QuiltsBeginBelow) {
  ASSERT_TRUE(WriteImage(folder_ / "a_qs2x2.png", Image<uint8_t>(20, 12, 3).view()));
  LightField light_field =
      *OpenLightField(folder_, {.focal_px = 9, .pitch_w = Vec2(1, 1), .plane_distance_w = 5});
  EXPECT_EQ(light_field.image_names,
            (std::vector<std::string>{"a_qs2x2.png#10x6+0+6", "a_qs2x2.png#10x6+10+6",
                                      "a_qs2x2.png#10x6+0+0", "a_qs2x2.png#10x6+10+0"}));
  EXPECT_EQ(light_field.Camera({3}).CentreWorld(), Vec3(1.5, 0, 0));
  // A mosaic begins above.
  light_field = *OpenLightField(folder_ / "a_qs2x2.png", {.focal_px = 9,
                                                          .pitch_w = Vec2(1, 2),
                                                          .grid = std::array{2, 2},
                                                          .layout = PictureLayout::kMosaic});
  EXPECT_EQ(light_field.image_names[2], "a_qs2x2.png#10x6+0+6");
  EXPECT_EQ(light_field.Camera({3}).CentreWorld(), Vec3(0.5, 1, 0));
}

TEST_F(PictureGridTest, OtherPicturesNeedAGrid) {
  ASSERT_TRUE(WriteImage(folder_ / "a.png", Image<uint8_t>(20, 12, 3).view()));
  const auto message_of = [&](const OpenOptions& options) {
    const Result<LightField> opened = OpenLightField(folder_ / "a.png", options);
    return opened ? std::string() : opened.error().message;
  };
  EXPECT_NE(message_of({}).find("is one image file: if it is a picture"), std::string::npos);
  // Black pixels show no views.
  EXPECT_NE(message_of({.layout = PictureLayout::kQuilt}).find("is one image file: if"),
            std::string::npos);
  EXPECT_NE(message_of({.grid = std::array{3, 2}}).find("cannot be divided into 3 x 2 views"),
            std::string::npos);
  EXPECT_NE(message_of({.grid = std::array{2, 2}}).find("no distance from one camera"),
            std::string::npos);
  EXPECT_EQ(message_of({.focal_px = 9, .pitch_w = Vec2(1, 1), .grid = std::array{2, 2}}), "");
}

TEST_F(PictureGridTest, FilesOfLytroAreNamed) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.lfr", "\x89LFP\r\n\x1a\n...."));
  EXPECT_NE(OpenLightField(folder_ / "a.lfr").error().message.find("plenopticam"),
            std::string::npos);
}

}  // namespace
}  // namespace lf
