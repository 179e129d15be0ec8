// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_cameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

ExportedImage ImageNamed(const std::string& name) {
  ExportedImage image;
  image.name = name;
  image.intrinsics.fx_px = image.intrinsics.fy_px = 500;
  image.intrinsics.cx_px = 320;
  image.intrinsics.cy_px = 240;
  image.intrinsics.width_px = 640;
  image.intrinsics.height_px = 480;
  return image;
}

ExportedCameras TwoCameras() {
  ExportedCameras cameras;
  cameras.folder = "f";
  cameras.images = {ImageNamed("a.png"), ImageNamed("b.png")};
  return cameras;
}

void ExpectExportError(const ExportedCameras& cameras, const std::string& part,
                       const ExportOptions& options = {}) {
  const Result<LightField> light_field = FinishExport(cameras, "f/export", options);
  ASSERT_FALSE(light_field);
  EXPECT_EQ(light_field.error().kind, ErrorKind::kInput);
  EXPECT_TRUE(light_field.error().message.starts_with("f/export: ")) << light_field.error().message;
  EXPECT_NE(light_field.error().message.find(part), std::string::npos)
      << part << "\nnot in: " << light_field.error().message;
}

TEST(FinishExport, StoresEqualIntrinsicsOnce) {
  ExportedCameras cameras = TwoCameras();
  cameras.images.push_back(ImageNamed("c.exr"));
  cameras.images[2].intrinsics.fx_px = 501;
  cameras.depth_range = DepthRange{1, 2};
  cameras.unit_m = 0.5;
  const Result<LightField> light_field = FinishExport(cameras, "f/export", {});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->intrinsics.size(), 2u);
  EXPECT_EQ(light_field->cameras[2].intrinsics_index, 1u);
  EXPECT_EQ(light_field->folder, "f");
  EXPECT_EQ(light_field->unit_m, 0.5);
  EXPECT_EQ(light_field->depth_range, (DepthRange{1, 2}));
  EXPECT_EQ(light_field->encoding.max_radiance, kFloatMaxRadiance);
}

TEST(FinishExport, RefusesWhatNoCameraHas) {
  ExpectExportError({}, "holds no image with a pose");
  ExportedCameras cameras = TwoCameras();
  cameras.images[1].name = "a.png";
  ExpectExportError(cameras, "image 2 (a.png): has the name of an earlier image");
  cameras.images[1].name = "";
  ExpectExportError(cameras, "has no name");
  cameras.images[1].name = std::string("b\0", 2);
  ExpectExportError(cameras, "NUL");
  cameras.images[1].name = std::string(5000, 'b');
  ExpectExportError(cameras, "5000 bytes");

  cameras = TwoCameras();
  cameras.images[1].intrinsics.fy_px = 0;
  ExpectExportError(cameras, "image 2 (b.png): has the focal lengths 500 and 0 pixels");
  cameras = TwoCameras();
  cameras.images[0].intrinsics.cx_px = std::nan("");
  ExpectExportError(cameras, "image 1 (a.png): has the principal point (nan, 240)");
  cameras = TwoCameras();
  cameras.images[0].intrinsics.width_px = 70000;
  ExpectExportError(cameras, "70000 x 480 pixels");
  cameras = TwoCameras();
  cameras.images[0].intrinsics.distortion = {DistortionModel::kFov, {7}};
  ExpectExportError(cameras, "a lens distortion whose numbers are too large or not valid");
  cameras = TwoCameras();
  cameras.images[0].cam_from_world.translation.x() = 2e12;
  ExpectExportError(cameras, "has its camera at (-2e+12");
}

TEST(FinishExport, TakesASizeThatIsNotStatedFromTheFirstImage) {
  ExportedCameras cameras = TwoCameras();
  for (ExportedImage& image : cameras.images)
    image.intrinsics.width_px = image.intrinsics.height_px = 0;
  int asked = 0;
  const ExportOptions options = {.image_size = [&](const fs::path& path) {
    EXPECT_EQ(path, "f/a.png");
    ++asked;
    return Result(std::array{100, 50});
  }};
  const Result<LightField> light_field = FinishExport(cameras, "f/export", options);
  ASSERT_TRUE(light_field);
  EXPECT_EQ(asked, 1);
  ASSERT_EQ(light_field->intrinsics.size(), 1u);
  EXPECT_EQ(light_field->intrinsics[0].width_px, 100);
  EXPECT_EQ(light_field->intrinsics[0].cx_px, 320);
}

// Bundler's principal points are the middles of photographs of any size.
TEST(FinishExport, CountsFromTheMiddleOfEachImage) {
  ExportedCameras cameras = TwoCameras();
  cameras.images.push_back(ImageNamed("gone.png"));
  for (ExportedImage& image : cameras.images) {
    image.intrinsics.width_px = image.intrinsics.height_px = 0;
    image.intrinsics.cx_px = 1;
    image.intrinsics.cy_px = -2;
  }
  cameras.sizes_from = SizesFrom::kEachImage;
  cameras.counts_from_middle = true;
  const ExportOptions options = {
      .image_size = [](const fs::path& path) -> Result<std::array<int, 2>> {
        if (path == "f/gone.png") return InputError("no such file");
        return path == "f/a.png" ? std::array{100, 50} : std::array{50, 100};
      }};
  const Result<LightField> light_field = FinishExport(cameras, "f/export", options);
  ASSERT_TRUE(light_field);
  const Intrinsics& second = light_field->Camera({1}).intrinsics;
  EXPECT_EQ(second.cx_px, 26);
  EXPECT_EQ(second.cy_px, 48);
  EXPECT_EQ(second.height_px, 100);
  EXPECT_EQ(light_field->Camera({2}).intrinsics.cx_px, 51);

  const auto refuses = [](const fs::path&) -> Result<std::array<int, 2>> {
    return InputError("no such file");
  };
  ExpectExportError(cameras, "does not state the sizes of the images", {.image_size = refuses});
}

// RealityCapture states lengths as shares of the larger side of each image.
TEST(FinishExport, ScalesByTheLargerSideOfEachImage) {
  ExportedCameras cameras = TwoCameras();
  for (ExportedImage& image : cameras.images) {
    Intrinsics& k = image.intrinsics;
    k.width_px = k.height_px = 0;
    k.fx_px = k.fy_px = 0.75;
    k.cx_px = 0.01;
    k.cy_px = -0.02;
  }
  cameras.sizes_from = SizesFrom::kEachImage;
  cameras.counts_from_middle = cameras.in_larger_sides = true;
  const ExportOptions options = {.image_size = [](const fs::path& path) {
    return Result(path == "f/a.png" ? std::array{200, 100} : std::array{100, 400});
  }};
  const Result<LightField> light_field = FinishExport(cameras, "f/export", options);
  ASSERT_TRUE(light_field) << light_field.error().message;
  const Intrinsics first = light_field->Camera({0}).intrinsics;
  EXPECT_EQ(first.fx_px, 150);
  EXPECT_EQ(first.cx_px, 102);
  EXPECT_EQ(first.cy_px, 46);
  const Intrinsics second = light_field->Camera({1}).intrinsics;
  EXPECT_EQ(second.fy_px, 300);
  EXPECT_EQ(second.cx_px, 54);
  EXPECT_EQ(second.cy_px, 192);
}

using ExportFiles = FolderTest;

// Only the extension tells that the image holds floating-point values, which may be brighter than
// white.
TEST_F(ExportFiles, TellTheExtensionThatANameLacks) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.exr", "x"));
  ExportedCameras cameras = TwoCameras();
  cameras.folder = folder_;
  cameras.images.resize(1);
  cameras.images[0].name = "a";
  const Result<LightField> light_field = FinishExport(cameras, "f/export", {});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names[0], "a.exr");
  EXPECT_EQ(light_field->encoding.max_radiance, kFloatMaxRadiance);
}

TEST_F(ExportFiles, AreFoundWhereverTheyLieWhenTheirSizesAreNeeded) {
  fs::create_directory(folder_ / "images");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "images" / "a.png", "x"));
  ExportedCameras cameras = TwoCameras();
  cameras.folder = folder_;
  cameras.images.resize(1);
  cameras.images[0].name = "C:\\scan\\a.jpg";
  cameras.images[0].intrinsics.width_px = cameras.images[0].intrinsics.height_px = 0;
  const ExportOptions options = {.image_size = [&](const fs::path& path) {
    EXPECT_EQ(path, folder_ / "images" / "a.png");
    return Result(std::array{100, 50});
  }};
  const Result<LightField> light_field = FinishExport(cameras, "f/export", options);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names[0], "images/a.png");
}

TEST(IntrinsicsOfRows, ReadsAMatrixRowByRow) {
  const std::optional<Intrinsics> k = IntrinsicsOfRows({9, 1, 4, 0, 8, 3, 0, 0, 1});
  ASSERT_TRUE(k);
  EXPECT_EQ(k->fx_px, 9);
  EXPECT_EQ(k->skew_px, 1);
  EXPECT_EQ(k->cx_px, 4);
  EXPECT_EQ(k->fy_px, 8);
  EXPECT_EQ(k->cy_px, 3);
  EXPECT_FALSE(IntrinsicsOfRows({9, 0, 0, 1, 8, 0, 4, 3, 1})) << "column by column";
  EXPECT_FALSE(IntrinsicsOfRows({9, 1, 4, 0, 8, 3, 0, 0, 2}));
}

TEST(ExportedRotation, TurnsAboutTheAxis) {
  const Mat3 expected = Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix();
  const Result<Mat3> by_axis = RotationOfAxisAngle({0, 0.5, 0});
  ASSERT_TRUE(by_axis);
  EXPECT_LT((*by_axis - expected).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(*RotationOfAxisAngle(Vec3::Zero()), Mat3::Identity());
  const Result<Mat3> by_quaternion = RotationOfQuaternion(std::cos(0.25), 0, std::sin(0.25), 0);
  ASSERT_TRUE(by_quaternion);
  EXPECT_LT((*by_quaternion - expected).cwiseAbs().maxCoeff(), 1e-15);
  const Result<Mat3> by_rows = RotationOfRows({0, -1, 0, 1, 0, 0, 0, 0, 1});
  ASSERT_TRUE(by_rows);
  EXPECT_EQ(*by_rows * Vec3(1, 0, 0), Vec3(0, 1, 0));
}

TEST(ExportedRotation, RefusesWhatIsNoRotation) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(RotationOfQuaternion(1, 1, 0, 0));
  EXPECT_FALSE(RotationOfQuaternion(nan, 0, 0, 0));
  EXPECT_FALSE(RotationOfAxisAngle({1e300, 0, 0}));
  EXPECT_FALSE(RotationOfAxisAngle({nan, 0, 0}));
  EXPECT_FALSE(RotationOfRows({1, 0, 0, 0, 1, 0, 0, 0, -1}));
}

}  // namespace
}  // namespace lf
