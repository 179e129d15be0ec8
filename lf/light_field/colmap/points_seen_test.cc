// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/points_seen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "lf/light_field/colmap/test_colmap.h"

namespace lf {
namespace {

// Two images whose order by name is not their order by id: 7 comes before 3. Neither camera is
// rotated; the camera of image 3 is at x = 10.
const std::string kCamerasText = "1 PINHOLE 8 6 10 11 4 3\n";
const std::string kImagesText = "3 1 0 0 0 -10 0 0 1 b.png\n\n7 1 0 0 0 0 0 0 1 a.png\n\n";

std::string Images() {
  return ImagesBin({{.id = 3, .translation = {-10, 0, 0}, .name = "b.png"}, {.id = 7}});
}

Result<std::vector<Vec3>> Seen(uint32_t position, std::string_view points, bool is_binary) {
  const std::string cameras = is_binary ? CamerasBin({TestCamera()}) : kCamerasText;
  const std::string images = is_binary ? Images() : kImagesText;
  const LightField light_field = ParseColmap(is_binary, cameras, images).value();
  ColmapStreams streams{ByteStream(cameras, "m/cameras"), ByteStream(images, "m/images"),
                        ByteStream(points, "m/points3D"), is_binary};
  const LfImageId id{std::min(position, uint32_t{1})};
  return ParseColmapPointsSeen(std::move(streams), position, light_field.Camera(id));
}

TEST(ColmapPointsSeen, TheyAreThoseWhoseTracksNameTheImage) {
  const std::string binary = PointsBin({{.id = 1, .xyz = {1, 2, 3}, .track = {3, 7}},
                                        {.id = 2, .xyz = {4, 5, 6}, .track = {3}},
                                        {.id = 3, .xyz = {0, 0, 9}},
                                        {.id = 5, .xyz = {7, 8, 9}, .track = {7}}});
  const std::string text =
      "1 1 2 3 9 9 9 0.5 3 0 7 1\n2 4 5 6 9 9 9 0.5 3 1\n3 0 0 9 9 9 9 0.5\n"
      "5 7 8 9 9 9 9 0.5 7 0\n";
  for (const bool is_binary : {false, true}) {
    const std::string& points = is_binary ? binary : text;
    EXPECT_EQ(Seen(0, points, is_binary).value(),
              (std::vector<Vec3>{Vec3(1, 2, 3), Vec3(7, 8, 9)}));
    EXPECT_EQ(Seen(1, points, is_binary).value(),
              (std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)}));
  }
}

// With fx = 10 px and a width of 8 px, the image shows points within 0.4 of the axis at depth 1.
TEST(ColmapPointsSeen, WithoutTracksTheyAreThoseThatProjectIntoTheImage) {
  const std::string points = PointsBin({{.id = 1, .xyz = {0.39, 0, 1}},
                                        {.id = 2, .xyz = {0.41, 0, 1}},
                                        {.id = 3, .xyz = {0.1, 0.1, -1}},
                                        {.id = 4, .xyz = {10, 0, 1}}});
  EXPECT_EQ(Seen(0, points, true).value(), std::vector<Vec3>{Vec3(0.39, 0, 1)});
  EXPECT_EQ(Seen(1, points, true).value(), std::vector<Vec3>{Vec3(10, 0, 1)});
  EXPECT_EQ(Seen(0, "8 0.1 0 1 9 9 9 0.5\n", false).value(), std::vector<Vec3>{Vec3(0.1, 0, 1)});
}

TEST(ColmapPointsSeen, OfManyAnEvenSampleIsTaken) {
  std::vector<TestPoint> points;
  constexpr int kCount = 50000;
  for (int i = 0; i < kCount; ++i)
    points.push_back({.id = static_cast<uint64_t>(i), .xyz = {0, 0, 1 + i * 1.0}, .track = {7}});
  const std::vector<Vec3> seen = Seen(0, PointsBin(points), true).value();
  EXPECT_LE(seen.size(), kMostPointsSeen);
  EXPECT_GE(seen.size(), kMostPointsSeen / 2 - 200);
  const auto lower = std::count_if(seen.begin(), seen.end(),
                                   [](const Vec3& point) { return point.z() < kCount / 2.; });
  EXPECT_NEAR(static_cast<double>(lower) / static_cast<double>(seen.size()), 0.5, 0.05);
  std::reverse(points.begin(), points.end());
  std::vector<Vec3> other = Seen(0, PointsBin(points), true).value();
  std::reverse(other.begin(), other.end());
  EXPECT_EQ(other, seen);
}

TEST(ColmapPointsSeen, AnImageBeyondTheModelIsAnError) {
  EXPECT_NE(
      Seen(2, PointsBin({}), true).error().message.find("m/images: has 2 images, but image 3"),
      std::string::npos);
}

}  // namespace
}  // namespace lf
