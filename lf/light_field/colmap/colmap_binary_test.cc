// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_binary.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lf/light_field/colmap/test_colmap.h"

namespace lf {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string ErrorOfImagesBin(const std::vector<TestImage>& images) {
  return ErrorOf(ParseColmap(true, CamerasBin({TestCamera()}), ImagesBin(images)));
}

TEST(ColmapBinary, ImagesComeSortedByName) {
  const Result<LightField> light_field = ParseColmap(
      true,
      CamerasBin({{.id = 9, .parameters = {10, 11, 4, 3}},
                  {.id = 5, .model = 0, .parameters = {20, 4, 3}},
                  {.id = 7, .parameters = {99, 99, 4, 3}}}),
      ImagesBin(
          {{.id = 4, .translation = {1, 0, 0}, .camera_id = 9, .name = "z/b c.png"},
           {.id = 8, .translation = {2, 0, 0}, .camera_id = 5, .name = "a.png", .point_count = 3},
           {.id = 1, .translation = {3, 0, 0}, .camera_id = 9, .name = "z/a.png"}}));
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, (std::vector<std::string>{"a.png", "z/a.png", "z/b c.png"}));
  EXPECT_EQ(light_field->cameras[0].cam_from_world.translation, Vec3(2, 0, 0));
  EXPECT_EQ(light_field->cameras[1].cam_from_world.translation, Vec3(3, 0, 0));
  EXPECT_EQ(light_field->cameras[2].cam_from_world.translation, Vec3(1, 0, 0));
  // Only cameras that took an image remain, in the order of their first images.
  ASSERT_EQ(light_field->intrinsics.size(), 2u);
  EXPECT_EQ(light_field->Camera({0}).intrinsics, (Intrinsics{20, 20, 4, 3, 0, 8, 6}));
  EXPECT_EQ(light_field->Camera({1}).intrinsics, (Intrinsics{10, 11, 4, 3, 0, 8, 6}));
  EXPECT_EQ(light_field->cameras[2].intrinsics_index, 1u);
  EXPECT_EQ(light_field->depth_range, std::nullopt);
}

TEST(ColmapBinary, QuaternionsAreWFirstAndNormalised) {
  const double h = std::sqrt(0.5) * 1.0005;
  const Result<LightField> light_field =
      ParseColmap(true, CamerasBin({TestCamera()}), ImagesBin({{.quaternion = {h, 0, 0, h}}}));
  ASSERT_TRUE(light_field) << light_field.error().message;
  Mat3 quarter_turn_about_z;
  quarter_turn_about_z << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_LT((light_field->cameras[0].cam_from_world.rotation - quarter_turn_about_z).norm(), 1e-15);
}

TEST(ColmapBinary, DepthsAreAlongTheOpticalAxisOfTheCamerasThatSeeThem) {
  const std::string images =
      ImagesBin({{.id = 3}, {.id = 6, .translation = {0, 0, 2}, .name = "b.png"}});
  const Result<LightField> light_field =
      ParseColmap(true, CamerasBin({TestCamera()}), images,
                  PointsBin({{.id = 1, .xyz = {50, 0, 3}, .track = {3}},
                             {.id = 2, .xyz = {0, 50, 4}, .track = {6}},
                             {.id = 3, .xyz = {0, 0, -1}, .track = {3, 6}},
                             {.id = 4, .xyz = {0, 0, 100}}}));
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->depth_range, (DepthRange{1, 6}));
}

TEST(ColmapBinary, NoPointsIsNoRange) {
  EXPECT_EQ(ParseColmap(true, CamerasBin({TestCamera()}), ImagesBin({TestImage()}), PointsBin({}))
                ->depth_range,
            std::nullopt);
}

TEST(ColmapBinary, BrokenImagesAreNamed) {
  EXPECT_HAS(ErrorOfImagesBin({}), "m/images.bin: holds no images");
  EXPECT_HAS(ErrorOfImagesBin({{.id = 5, .camera_id = 2}}),
             "m/images.bin: image 5 has the camera "
             "ID 2, which none of the 1 cameras");
  EXPECT_HAS(ErrorOfImagesBin({{.quaternion = {0, 0, 0, 0}}}),
             "image 1 has the quaternion 0 0 0 0");
  EXPECT_HAS(ErrorOfImagesBin({{.quaternion = {1.002, 0, 0, 0}}}),
             "expected a rotation, of norm 1");
  EXPECT_HAS(ErrorOfImagesBin({{.quaternion = {1, kNan, 0, 0}}}), "has the quaternion 1 nan 0 0");
  EXPECT_HAS(ErrorOfImagesBin({{.translation = {1, kNan, 0}}}), "has the translation 1 nan 0");
  EXPECT_HAS(ErrorOfImagesBin({{.translation = {1, 0, -1e13}}}),
             "has the translation 1 0 -10000000000000");
  EXPECT_HAS(ErrorOfImagesBin({{.name = ""}}), "has no name");
  EXPECT_HAS(ErrorOfImagesBin({{.name = "a\nb"}}), "control characters");
  EXPECT_HAS(ErrorOfImagesBin({{.name = std::string(5000, 'x')}}), "more than 4096 bytes");
  EXPECT_HAS(ErrorOfImagesBin({{.id = 1}, {.id = 1, .name = "b"}}), "two images have the ID 1");
  EXPECT_HAS(ErrorOfImagesBin({{.id = 8}, {.id = 3}}),
             "the images with the IDs 3 and 8 have the same name a.png");
}

TEST(ColmapBinary, BrokenCamerasAreNamed) {
  const std::string images = ImagesBin({TestImage()});
  const auto error = [&](const std::vector<TestCamera>& cameras) {
    return ErrorOf(ParseColmap(true, CamerasBin(cameras), images));
  };
  EXPECT_HAS(error({{.id = 6, .model = 17, .parameters = {8, 6}}}),
             "m/cameras.bin: camera 6 has the camera model EQUIRECTANGULAR, which is a panorama");
  EXPECT_HAS(error({{.model = 77}}), "camera 1 has the camera model number 77");
  EXPECT_HAS(error({{.width = 0}}), "camera 1 has images of 0 x 6 pixels");
  EXPECT_HAS(error({{.parameters = {10, kNan, 4, 3}}}), "10 nan 4 3");
  EXPECT_HAS(error({TestCamera(), TestCamera()}), "m/cameras.bin: two cameras have the ID 1");
}

TEST(ColmapBinary, BrokenPointsAreNamed) {
  const auto error = [&](const std::string& points) {
    return ErrorOf(ParseColmap(true, CamerasBin({TestCamera()}), ImagesBin({TestImage()}), points));
  };
  EXPECT_HAS(error(PointsBin({{.id = 9, .xyz = {0, kNan, 1}}})), "point 9 lies at 0 nan 1");
  EXPECT_HAS(
      error(PointsBin({{.id = 9, .track = {1, 2}}})),
      "m/points3D.bin: point 9 is seen by the image with ID 2, which the images file does not");
  std::string long_track = PointsBin({TestPoint()});
  long_track[long_track.size() - 8] = 1;
  EXPECT_HAS(error(long_track), "point 1 says that 1 images see it, but only 0 bytes are left");
  // The file holds a track of two entries, 8 bytes each. `claimed` states another length.
  const std::string two = PointsBin({{.track = {1, 1}}});
  for (const uint64_t count : {uint64_t{3}, uint64_t{16}, uint64_t{1} << 61, UINT64_MAX}) {
    const std::string claimed = two.substr(0, two.size() - 24) + PackedBytes().Put(count).bytes() +
                                two.substr(two.size() - 16);
    EXPECT_HAS(
        error(claimed),
        fmt::format("point 1 says that {} images see it, but only 16 bytes are left", count));
  }
}

TEST(ColmapBinary, CountsBeyondTheFileAreErrors) {
  const auto with_count = [](std::string file, uint64_t count) {
    return PackedBytes().Put(count).bytes() + file.substr(8);
  };
  const std::string cameras = CamerasBin({TestCamera()}), images = ImagesBin({TestImage()});
  for (const uint64_t count : {uint64_t{2}, uint64_t{1} << 40, UINT64_MAX}) {
    EXPECT_HAS(ErrorOf(ParseColmap(true, with_count(cameras, count), images)),
               fmt::format("m/cameras.bin: says that it holds {} cameras", count));
    EXPECT_HAS(ErrorOf(ParseColmap(true, cameras, with_count(images, count))),
               fmt::format("m/images.bin: says that it holds {} images", count));
    EXPECT_HAS(ErrorOf(ParseColmap(true, cameras, images, with_count(PointsBin({}), count))),
               fmt::format("m/points3D.bin: says that it holds {} points", count));
    std::string many_points = images;
    many_points.resize(many_points.size() - 8);
    many_points += PackedBytes().Put(count).bytes();
    EXPECT_HAS(ErrorOf(ParseColmap(true, cameras, many_points)),
               fmt::format("image 1 says that it has {} 2D points", count));
  }
}

TEST(ColmapBinary, AFileThatIsCutOffAnywhereIsAnError) {
  const std::string cameras = CamerasBin({{.id = 1}, {.id = 2}});
  const std::string images = ImagesBin({{.id = 1, .point_count = 2}, {.id = 2, .name = "b"}});
  const std::string points = PointsBin({{.id = 1, .track = {1, 2}}, {.id = 2, .track = {2}}});
  ASSERT_TRUE(ParseColmap(true, cameras, images, points));
  const auto starts = [](const std::string& message, const char* place) {
    EXPECT_EQ(message.find(place), 0u) << message;
  };
  for (size_t size = 0; size < cameras.size(); ++size)
    starts(ErrorOf(ParseColmap(true, cameras.substr(0, size), images)), "m/cameras.bin: ");
  for (size_t size = 0; size < images.size(); ++size)
    starts(ErrorOf(ParseColmap(true, cameras, images.substr(0, size))), "m/images.bin: ");
  for (size_t size = 0; size < points.size(); ++size)
    starts(ErrorOf(ParseColmap(true, cameras, images, points.substr(0, size))), "m/points3D.bin: ");
  EXPECT_HAS(ErrorOf(ParseColmap(true, cameras + "x", images)),
             "1 bytes after the last of its 2 cameras");
  EXPECT_HAS(ErrorOf(ParseColmap(true, cameras, images + "x")),
             "1 bytes after the last of its 2 images");
  EXPECT_HAS(ErrorOf(ParseColmap(true, cameras, images, points + "x")),
             "after the last of its 2 points");
}

}  // namespace
}  // namespace lf
