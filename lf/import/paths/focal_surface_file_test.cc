// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/focal_surface_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "lf/camera/path/path_yaml.h"
#include "lf/camera/path/path_yaml_write.h"
#include "lf/core/file.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/write_path.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

std::string PfmText(int width, int height, const std::vector<float>& values) {
  std::string bytes = "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1\n";
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return bytes;
}

std::string PathText(const std::string& focus, const std::string& more = "") {
  return "format: lfpath 1\nfps: 1\nframes: 2\nresolution: [16, 12]\n" + more +
         "camera: {sensor_width: 1, focal_length: 1, position: [0, 0, 10], look_at: [0, 0, 0], "
         "up: [0, 1, 0]}\nlens: {aperture_diameter: 1, focus_distance: 5}\n" +
         focus;
}

// Returns the message of opening a path to be rendered; empty if it opens.
std::string ErrorOf(const std::filesystem::path& file) {
  PathOptions options;
  options.surface = PathOptions::Surface::kMake;
  options.camera_distance_w = 0.1;
  const auto opened = OpenPath(file, options);
  return opened ? std::string() : opened.error().message;
}

class FocalSurfaceFolder : public FolderTest {};

TEST_F(FocalSurfaceFolder, FilesThatHoldNoSurfaceAreErrorsThatSayWhatIsWrong) {
  const auto path = folder_ / "p.yaml";
  const auto expect = [&](const std::string& focus, const std::string& words,
                          const std::string& more = "") {
    ASSERT_TRUE(WriteFileAtomically(path, PathText(focus, more)));
    const std::string message = ErrorOf(path);
    EXPECT_NE(message.find(words), std::string::npos) << focus << ": " << message;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(WriteFileAtomically(folder_ / "nan.pfm", PfmText(4, 3, std::vector<float>(12, nan))));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "high.pfm", PfmText(2, 9, std::vector<float>(18, 1))));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "flat.pfm", PfmText(4, 3, std::vector<float>(12, 5))));
  ASSERT_TRUE(WriteImage(folder_ / "rgb.exr", Image<float>(4, 3, 3).view(), {"R", "G", "B"},
                         PixelType::kFloat));
  const auto depth = [](const std::string& file) {
    return "focus: {surface: " + file + ", kind: depth}\n";
  };
  expect(depth("missing.pfm"), "missing.pfm");
  expect(depth("nan.pfm"), "holds no depth");
  expect(depth("high.pfm"), "same shape");
  expect(depth("rgb.exr"), "a channel named Z");
  expect("focus: {surface: flat.pfm}\n", "kind is missing");
  expect("focus: {surface: flat.pfm, kind: dept}\n", "dept");
  expect("focus: {surface: flat.pfm, kind: depth, origin: [0, 0, 0]}\n", "origin");
  expect("focus: {surface: flat.pfm, kind: height}\n", "origin");
  expect("focus: {surface: flat.pfm, kind: height, origin: [0, 0, 0], cell: 1, up: [1, 0, 0]}\n",
         "right angles");
  expect("focus: {surface: flat.pfm, kind: height, origin: [900, 0, 0], cell: 1}\n",
         "sees the height map");
  expect(depth("flat.pfm"), "seen from the camera of one moment",
         "shutter: {angle_deg: 180, samples: 2}\n");
  ASSERT_TRUE(WriteFileAtomically(path, PathText(depth("flat.pfm"))));
  EXPECT_EQ(ErrorOf(path), "");
  EXPECT_NE(OpenPath(path, {}).error().message.find("focus planes only"), std::string::npos);
}

TEST_F(FocalSurfaceFolder, ADepthPictureOfEachFrameGivesItsSurface) {
  const auto path = folder_ / "p.yaml";
  for (int frame = 1; frame <= 2; ++frame)
    ASSERT_TRUE(WriteFileAtomically(
        folder_ / ("z_000" + std::to_string(frame) + ".pfm"),
        PfmText(16, 12, std::vector<float>(16 * 12, static_cast<float>(4 * frame)))));
  ASSERT_TRUE(WriteFileAtomically(
      path, PathText("focus: {surface: z_%04d.pfm, kind: depth, scale: 0.5}\n")));
  PathOptions options;
  options.surface = PathOptions::Surface::kMake;
  const auto opened = OpenPath(path, options);
  ASSERT_TRUE(opened) << opened.error().message;
  for (int frame = 1; frame <= 2; ++frame) {
    const RenderCamera& camera = opened->cameras[static_cast<size_t>(frame) - 1];
    ASSERT_TRUE(camera.surface);
    EXPECT_EQ(camera.surface->pieces().size(), 1u);
    EXPECT_NEAR(camera.surface->PieceAt(3, 3).At(3.5, 3.5), 1.0 / (2 * frame), 1e-7);
  }
  EXPECT_EQ(FilesOfPath(path).size(), 3u);
  EXPECT_EQ(FilesOfPath(path)[2], folder_ / "z_0002.pfm");
}

// Four places of a depth picture become 8 x 4 elements: the centre of a place is that of a square
// of 2 x 2 elements, so that inverse depths between two centres have the shares 1/4 and 3/4.
TEST(FocalSurfaceFile, ElementsBetweenPlacesOfOneSurfaceHaveDepthsBetweenTheirs) {
  Image<float> depths(4, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) depths.at(x, y) = static_cast<float>(1 / (0.5 + 0.01 * x));
  const Image<float> inverse = InverseDepthsOfPicture(depths, 0.5, 8, 4);
  const double expected[] = {1, 1.005, 1.015, 1.025, 1.035, 1.045, 1.055, 1.06};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(inverse.at(x, y), expected[x], 1e-6) << x << " " << y;
  // Elements that are larger than places take the depth at their centre.
  const Image<float> coarse = InverseDepthsOfPicture(depths, 0.5, 2, 1);
  EXPECT_NEAR(coarse.at(0, 0), 1.01, 1e-6);
  EXPECT_NEAR(coarse.at(1, 0), 1.05, 1e-6);
}

TEST(FocalSurfaceFile, ElementsAtAnEdgeHaveTheDepthOfTheNearestPlace) {
  Image<float> depths(4, 1);
  for (int x = 0; x < 4; ++x)
    depths.at(x, 0) = std::vector<float>{2, 2, 4, 0}[static_cast<size_t>(x)];
  const Image<float> inverse = InverseDepthsOfPicture(depths, 1, 8, 2);
  const float expected[] = {0.5, 0.5, 0.5, 0.5, 0.25, 0.25, 0, 0};
  for (int x = 0; x < 8; ++x) EXPECT_EQ(inverse.at(x, 0), expected[x]) << x;
  // 4 % apart is one surface, 6 % is an edge.
  depths.at(2, 0) = 2 * 1.04F;
  EXPECT_NEAR(InverseDepthsOfPicture(depths, 1, 8, 2).at(3, 0), 0.5 - 0.25 * (0.5 - 0.5 / 1.04),
              1e-6);
  depths.at(2, 0) = 2 * 1.06F;
  EXPECT_EQ(InverseDepthsOfPicture(depths, 1, 8, 2).at(3, 0), 0.5F);
}

TEST_F(FocalSurfaceFolder, AValueThatStandsForNoDataIsUnknown) {
  // Without a stated value, 7 would be a depth, and the surface would have two of them.
  std::vector<float> depths(16 * 12, 7);
  for (size_t i = 0; i < depths.size(); i += 16) std::fill_n(&depths[i], 6, 4.0F);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "z.pfm", PfmText(16, 12, depths)));
  PathOptions options;
  options.surface = PathOptions::Surface::kMake;
  for (const bool is_stated : {true, false}) {
    const std::string more = is_stated ? ", nodata: 7" : "";
    ASSERT_TRUE(WriteFileAtomically(
        folder_ / "p.yaml", PathText("focus: {surface: z.pfm, kind: depth" + more + "}\n")));
    const auto opened = OpenPath(folder_ / "p.yaml", options);
    ASSERT_TRUE(opened) << opened.error().message;
    const FocalSurface& surface = *opened->cameras[0].surface;
    EXPECT_NEAR(surface.PieceAt(14, 6).At(14.5, 6.5), is_stated ? 1.0 / 4 : 1.0 / 7, 1e-6);
  }
}

TEST_F(FocalSurfaceFolder, APictureOfDepthsForPeopleIsNoDepthPicture) {
  Image<uint8_t> grey(16, 12);
  std::fill(grey.pixels().begin(), grey.pixels().end(), uint8_t{40});
  ASSERT_TRUE(WriteImage(folder_ / "z.png", grey.view()));
  const auto path = folder_ / "p.yaml";
  ASSERT_TRUE(WriteFileAtomically(path, PathText("focus: {surface: z.png, kind: depth}\n")));
  EXPECT_NE(ErrorOf(path).find("z.png: has 8 bits"), std::string::npos) << ErrorOf(path);
  ASSERT_TRUE(
      WriteFileAtomically(path, PathText("focus: {surface: z.png, kind: depth, scale: 0.1}\n")));
  EXPECT_EQ(ErrorOf(path), "");
}

// A roof z = 2 - |x| / 2 of the world, seen by a camera 10 above z = 0 that looks down.
TEST(FocalSurfaceFile, HeightsAreMetFromAbove) {
  PinholeCamera camera;
  camera.intrinsics = {20, 20, 16, 12, 0, 32, 24};
  camera.cam_from_world =
      *LookAlong({0.3, -0.2, 10}, Vec3(0.1, 0.2, -1).normalized(), Vec3(0, 1, 0));
  FocalSurfaceSource source;
  source.kind = FocalSurfaceSource::Kind::kHeights;
  source.scale = 0.5;
  source.offset_w = 1;
  source.origin_w = {-20, 20, 0};
  source.right_w = {0.5, 0, 0};
  source.down_w = {0, -0.5, 0};
  Image<float> values(81, 81);
  for (int y = 0; y < 81; ++y)
    for (int x = 0; x < 81; ++x)
      values.at(x, y) = static_cast<float>(2 * (2 - std::abs(-20 + 0.5 * x) / 2 - 1));
  const Image<float> inverse = InverseDepthsOfHeights(camera, values, source);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x) {
      ASSERT_GT(inverse.at(x, y), 0) << x << " " << y;
      const Vec3 point = RayOfPixel(camera, x + 0.5, y + 0.5).At(1 / double{inverse.at(x, y)});
      EXPECT_NEAR(point.z(), 2 - std::abs(point.x()) / 2, 1e-4) << x << " " << y;
    }
}

// A wall that is less than a cell wide where lines meet it hides what is behind it. The camera is
// over the middle of a cell, so that steps of a whole cell would pass over the wall.
TEST(FocalSurfaceFile, ANarrowWallIsMetFirst) {
  PinholeCamera camera;
  camera.intrinsics = {200, 200, 16, 1, 0, 32, 2};
  camera.cam_from_world = *LookAlong({-10, 0, 2}, Vec3(1, 0, -0.01).normalized(), Vec3(0, 0, 1));
  FocalSurfaceSource source;
  source.kind = FocalSurfaceSource::Kind::kHeights;
  source.origin_w = {-20.5, 30, 0};
  source.right_w = {1, 0, 0};
  source.down_w = {0, -1, 0};
  for (int wall = 20; wall < 60; wall += 3) {
    Image<float> heights(120, 61);
    for (int y = 0; y < 61; ++y)
      for (int x = 0; x < 120; ++x) heights.at(x, y) = x == wall ? 2.6F : 0.0F;
    const Image<float> inverse = InverseDepthsOfHeights(camera, heights, source);
    for (int x = 0; x < 32; ++x) {
      ASSERT_GT(inverse.at(x, 0), 0) << wall << " " << x;
      const Vec3 point = RayOfPixel(camera, x + 0.5, 0.5).At(1 / double{inverse.at(x, 0)});
      EXPECT_GT(point.x(), wall - 21.5) << wall << " " << x;
      EXPECT_LT(point.x(), wall - 20.5) << wall << " " << x;
    }
  }
}

TEST(FocalSurfaceFile, AMovedPathKeepsTheMapOnItsPlaceAndYamlKeepsItsKeys) {
  const std::string focus =
      "focus: {surface: \"a \\\"map\\\".tif\", kind: height, origin: [1, 2, 3], cell: 0.5, "
      "right: [0, 2, 0], down: [-1, 0, 0], up: [0, 0, 1], scale: 0.01, offset: -4, nodata: -99, "
      "blur: 0.25}\n";
  const auto parsed = ParsePathYaml(PathText(focus), "p.yaml", 1.0);
  ASSERT_TRUE(parsed) << parsed.error().message;
  ASSERT_TRUE(parsed->focal_surface);
  const FocalSurfaceSource& a = *parsed->focal_surface;
  EXPECT_EQ(a.file, "a \"map\".tif");
  EXPECT_EQ(a.right_w, Vec3(0, 0.5, 0));
  const auto yaml = PathYamlOf(*parsed);
  ASSERT_TRUE(yaml) << yaml.error().message;
  const auto again = ParsePathYaml(yaml->text, "again.yaml", 1.0);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_TRUE(again->focal_surface == parsed->focal_surface) << yaml->text;
  CameraPath moved = *parsed;
  Similarity similarity;
  similarity.scale = 2;
  similarity.rotation = Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()).toRotationMatrix();
  similarity.translation = {0, 0, 7};
  ASSERT_TRUE(MovePath(similarity, "p.yaml", &moved));
  const FocalSurfaceSource& b = *moved.focal_surface;
  const auto place = [](const FocalSurfaceSource& s, double c, double r, double v) -> Vec3 {
    return s.origin_w + c * s.right_w + r * s.down_w + (s.scale * v + s.offset_w) * s.up;
  };
  const Vec3 before = place(a, 3, 5, 100);
  EXPECT_NEAR(
      (place(b, 3, 5, 100) - (2 * (similarity.rotation * before) + similarity.translation)).norm(),
      0, 1e-9);
}

}  // namespace
}  // namespace lf
