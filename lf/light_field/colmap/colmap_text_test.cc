// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lf/core/file.h"
#include "lf/light_field/colmap/test_colmap.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

constexpr const char* kCameras = "# a comment\n1 PINHOLE 8 6 10 11 4 3\n";
constexpr const char* kImages = "1 1 0 0 0 0 0 0 1 a.png\n\n";

std::string ErrorOfCameras(const char* cameras) {
  return ErrorOf(ParseColmap(false, cameras, kImages));
}
std::string ErrorOfImages(const std::string& images) {
  return ErrorOf(ParseColmap(false, kCameras, images));
}
std::string ErrorOfPoints(const char* points) {
  return ErrorOf(ParseColmap(false, kCameras, kImages, points));
}

TEST(ColmapText, TakesCommentsBlankLinesAndDosLineEnds) {
  const Result<LightField> light_field =
      ParseColmap(false, "#\r\n\r\n  1\tPINHOLE 8 6  10 11 4 3 \r\n# end",
                  "# Image list\n#   of a newer form\n\n"
                  " 2 1 0 0 0 1e-3 -2.5 3 1 b with blanks.png \r\n"
                  "1.5 2.5 -1 3 4 7 \r\n"
                  "\n# between images\n\n"
                  "1 1 0 0 0 0 0 0 1 sub/a.png\n"
                  "\n"
                  "3 1 0 0 0 0 0 0 1 last.png",
                  "\n# no points\n");
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names,
            (std::vector<std::string>{"b with blanks.png", "last.png", "sub/a.png"}));
  EXPECT_EQ(light_field->cameras[0].cam_from_world.translation, Vec3(1e-3, -2.5, 3));
  EXPECT_EQ(light_field->intrinsics, (std::vector<Intrinsics>{{10, 11, 4, 3, 0, 8, 6}}));
  EXPECT_EQ(light_field->depth_range, std::nullopt);
}

TEST(ColmapText, TakesAByteOrderMarkAndCommasBehindWords) {
  const Result<LightField> light_field =
      ParseColmap(false, "\xef\xbb\xbf# cameras\n1, PINHOLE, 8, 6, 10, 11, 4, 3\n",
                  "\xef\xbb\xbf"
                  "2, 1, 0, 0, 0, 1e-3, -2.5, 3, 1, b, with a comma,\n"
                  "1.5, 2.5, -1, 3, 4, 7\n");
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, (std::vector<std::string>{"b, with a comma,"}));
  EXPECT_EQ(light_field->cameras[0].cam_from_world.translation, Vec3(1e-3, -2.5, 3));
  EXPECT_EQ(light_field->intrinsics, (std::vector<Intrinsics>{{10, 11, 4, 3, 0, 8, 6}}));
  EXPECT_HAS(ErrorOfCameras("1 PINHOLE 8 6 10,5 11 4 3"), "PARAMS[0] of 4 PINHOLE is \"10,5\"");
}

// This is the example of doc/formats/colmap.md.
TEST(ColmapText, TheExampleOfThePageIsTrue) {
  const Result<LightField> light_field =
      ParseColmap(false, "# cameras.txt\n1 SIMPLE_RADIAL 720 1280 1100 360 640 0.05\n",
                  "# images.txt\n"
                  "4 0.7071067811865476 0 0.7071067811865476 0 0 0 2 1 left/0001.jpg\n"
                  "412.5 300.25 7 88 14.5 -1\n");
  ASSERT_TRUE(light_field) << light_field.error().message;
  const PinholeCamera camera = light_field->Camera({0});
  EXPECT_LT((camera.CentreWorld() - Vec3(2, 0, 0)).norm(), 1e-15);
  EXPECT_LT((camera.ForwardWorld() - Vec3(-1, 0, 0)).norm(), 1e-15);
  const std::optional<Vec2> bent =
      DistortionMap(camera.intrinsics.distortion).Distort(camera.cam_from_world * Vec3(0, 0, 0.2));
  ASSERT_TRUE(bent);
  EXPECT_NEAR(camera.intrinsics.fx_px * bent->x() + camera.intrinsics.cx_px, 470.055, 1e-12);
  EXPECT_NEAR(camera.intrinsics.fy_px * bent->y() + camera.intrinsics.cy_px, 640, 1e-12);
}

TEST(ColmapText, PointsGiveTheRangeOfDepths) {
  const Result<LightField> light_field =
      ParseColmap(false, kCameras, "5 1 0 0 0 0 0 2 1 a.png\n\n",
                  "# points\n7 1 2 3 255 0 9 0.25 5 0\n8 9 9 1 0 0 0 -1 5 1 5 2\n9 0 0 7 0 0 0 1");
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->depth_range, (DepthRange{3, 5}));
}

TEST(ColmapText, BrokenCamerasAreNamedWithTheirLine) {
  EXPECT_HAS(ErrorOfCameras("#\nx PINHOLE 8 6 10 11 4 3"),
             "m/cameras.txt:2: CAMERA_ID is \"x\": expected a whole number from 0 to 4294967295");
  EXPECT_HAS(ErrorOfCameras("4294967296 PINHOLE 8 6 10 11 4 3"), "m/cameras.txt:1: CAMERA_ID is");
  EXPECT_HAS(ErrorOfCameras("-1 PINHOLE 8 6 10 11 4 3"), "CAMERA_ID is \"-1\"");
  EXPECT_HAS(ErrorOfCameras("3 EQUIRECTANGULAR 8 6 1 1 4 3 1 1"),
             "m/cameras.txt:1: camera 3 has the camera model EQUIRECTANGULAR, which is a panorama");
  EXPECT_HAS(ErrorOfCameras("3 OPENCV2 8 6 1 1 4 3 1 1"),
             "m/cameras.txt:1: camera 3 has the camera model \"OPENCV2\", which is not "
             "supported: undist");
  EXPECT_HAS(ErrorOfCameras("3"), "camera 3 has the camera model \"\"");
  EXPECT_HAS(ErrorOfCameras("3 PINHOLE 8"), "HEIGHT is missing");
  EXPECT_HAS(ErrorOfCameras("3 PINHOLE 8 6.5 10 11 4 3"), "HEIGHT is \"6.5\"");
  EXPECT_HAS(ErrorOfCameras("3 PINHOLE 8 0 10 11 4 3"), "camera 3 has images of 8 x 0 pixels");
  EXPECT_HAS(ErrorOfCameras("3 PINHOLE 8 6 10 11 4"), "PARAMS[3] of 4 PINHOLE is missing");
  EXPECT_HAS(ErrorOfCameras("3 PINHOLE 8 6 10 nan 4 3"), "PARAMS[1] of 4 PINHOLE is \"nan\"");
  EXPECT_HAS(ErrorOfCameras("3 PINHOLE 8 6 10 11 4 3 2"), "more parameters than the 4 of PINHOLE");
  EXPECT_HAS(ErrorOfCameras("1 PINHOLE 8 6 10 11 4 3\n1 PINHOLE 8 6 10 11 4 3"),
             "m/cameras.txt: two cameras have the ID 1");
}

TEST(ColmapText, BrokenImagesAreNamedWithTheirLine) {
  EXPECT_HAS(ErrorOfImages("# nothing\n"), "m/images.txt: holds no images");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1 a.png\n1 2 3\n2 1 0 0 zero 0 0 0 1 b.png\n"),
             "m/images.txt:3: QZ is \"zero\": expected a finite number");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 inf 0 1 a.png"), "TY is \"inf\"");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0"), "TZ is missing");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1.5 a.png"), "CAMERA_ID is \"1.5\"");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1"), "m/images.txt:1: image 1 has no name");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 2 a.png"), "image 1 has the camera ID 2");
  EXPECT_HAS(ErrorOfImages("1 2 0 0 0 0 0 0 1 a.png"), "image 1 has the quaternion 2 0 0 0");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1 " + std::string(5000, 'x')), "more than 4096 bytes");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1 a\n\n1 1 0 0 0 0 0 0 1 b\n"),
             "two images have the ID 1");
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1 a\n\n2 1 0 0 0 0 0 0 1 a\n"),
             "m/images.txt: the images with the IDs 1 and 2 have the same name a");
}

TEST(ColmapText, AnotherNumberOfImagesThanAnnouncedIsAWarning) {
  const auto messages = [](const std::string& start) {
    testing::internal::CaptureStderr();
    EXPECT_TRUE(ParseColmap(false, kCameras, start + kImages));
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_HAS(messages("# Number of images: 2, mean observations per image: 5\n"),
             "m/images.txt: holds 1 images, but the comment at its start states 2");
  EXPECT_EQ(messages("# Number of images: 1, mean observations per image: 5\n"), "");
  EXPECT_EQ(messages("# Number of things\n"), "");
}

// The second line of an image without 2D points is blank. If a file that lacks such lines were
// accepted, every second image would be lost.
TEST(ColmapText, AnImageInThePlaceOfPointsIsAnError) {
  const char* expected =
      "m/images.txt:2: expected the 2D points of the image with ID 1 (three numbers X Y POINT3D_ID";
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1 a.png\n2 1 0 0 0 0 0 0 1 b.png\n"), expected);
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1 a.png\n2 1 0 0 0 0 0 0 1 b c d.png\n"), expected);
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1 10\n2 1 0 0 0 0 0 0 1 20\n"), expected);
  EXPECT_HAS(ErrorOfImages("1 1 0 0 0 0 0 0 1 a.png\n1.5 2.5\n"), expected);
}

TEST(ColmapText, BrokenPointsAreNamedWithTheirLine) {
  EXPECT_HAS(ErrorOfPoints("1 0 0 1 0 0 0 0\n2 0 0 x 0 0 0 0"), "m/points3D.txt:2: Z is \"x\"");
  EXPECT_HAS(ErrorOfPoints("1 0 0 1 0 256 0 0"), "G is \"256\": expected a whole number from 0 to");
  EXPECT_HAS(ErrorOfPoints("1 0 0 1 0 0 0"), "ERROR is missing");
  EXPECT_HAS(ErrorOfPoints("1 0 0 1 0 0 0 0 1"), "POINT2D_IDX of a track is missing");
  EXPECT_HAS(
      ErrorOfPoints("1 0 0 1 0 0 0 0 3 0"),
      "m/points3D.txt:1: point 1 is seen by the image with ID 3, which the images file does not");
}

TEST(ColmapText, WhatIsNoTextIsShownShort) {
  const std::string error =
      ErrorOfImages(std::string("\x01\x00\x1b[31m", 7) + std::string(3000, 'y'));
  EXPECT_HAS(error, "IMAGE_ID is \"???[31m");
  EXPECT_LT(error.size(), 200u);
}

class ColmapTextFileTest : public FolderTest {};

// Words, lines and names cross the ends of the blocks that ByteStream reads.
TEST_F(ColmapTextFileTest, LinesMayBeLongerThanBlocks) {
  std::string points;
  while (points.size() < (size_t{3} << 20)) points += "123.4567 89.0123 77 ";
  std::string images;
  for (int i = 1; i <= 4; ++i)
    images += fmt::format("{} 1 0 0 0 {}.5 0 0 1 {}.png\n{}\n", i, i, i, points);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "cameras.txt", kCameras));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "images.txt", images));
  const Result<LightField> light_field = ReadColmapModel(folder_, folder_);
  ASSERT_TRUE(light_field) << light_field.error().message;
  ASSERT_EQ(light_field->size(), 4u);
  for (uint32_t i = 0; i < 4; ++i)
    EXPECT_EQ(light_field->cameras[i].cam_from_world.translation.x(), i + 1.5);
}

}  // namespace
}  // namespace lf
