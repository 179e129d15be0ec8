// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_aos.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

LightField ParsedAos(const std::string& text) {
  Result<LightField> light_field = ParseAosPoses(text, "data/poses.json");
  EXPECT_TRUE(light_field) << light_field.error().message << "\n" << text;
  return light_field ? *std::move(light_field) : LightField{};
}

void ExpectAosError(const std::string& text, const std::vector<std::string>& parts) {
  const Result<LightField> light_field = ParseAosPoses(text, "data/poses.json");
  ASSERT_FALSE(light_field) << text;
  const std::string& message = light_field.error().message;
  EXPECT_EQ(message.find("data/poses.json: "), 0u) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

std::string Entry(const std::string& name, const std::string& matrix) {
  return R"({"imagefile": ")" + name + R"(", "M3x4": )" + matrix + "}";
}

constexpr const char* kUnturnedMatrix = "[[1,0,0,1], [0,1,0,2], [0,0,1,3]]";

TEST(Aos, MatricesAreCamFromWorldWithNumbersOrStrings) {
  const LightField light_field = ParsedAos(
      R"({"site": "x", "images": [)" + Entry("a.png", kUnturnedMatrix) + "," +
      Entry("b.tiff", R"([["0", "-1", "0.0", "1e1"], [1,0,0,-2.5], ["0","0",1,"3"]])") + "]}");
  ASSERT_EQ(light_field.size(), 2u);
  EXPECT_EQ(light_field.image_names, (std::vector<std::string>{"a.png", "b.tiff"}));
  EXPECT_EQ(light_field.cameras[0].cam_from_world * Vec3(10, 20, 30), Vec3(11, 22, 33));
  EXPECT_EQ(light_field.cameras[1].cam_from_world * Vec3(10, 20, 30), Vec3(-10, 7.5, 33));
}

// Published files have nine digits, as many as 32-bit floats need. In this pose a drone is 56 m
// above the ground.
TEST(Aos, RotationsOfNineDigitsAreRotationsAgain) {
  const LightField light_field =
      ParsedAos(R"({"images": [)" +
                Entry("a.tiff", R"([["0.559273303", "-0.826043189", "0.0697564408", "4.15129662"],
                          ["0.812924504", "0.530011594", "-0.241332605", "-14.9073343"],
                          ["0.162379429", "0.19167763", "0.967932045", "55.9572182"]])") +
                "]}");
  const RigidTransform& pose = light_field.cameras[0].cam_from_world;
  EXPECT_LT((pose.rotation * pose.rotation.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff(),
            1e-15);
  EXPECT_NEAR(pose.rotation(1, 0), 0.812924504, 1e-7);
  EXPECT_EQ(pose.translation, Vec3(4.15129662, -14.9073343, 55.9572182));
}

TEST(Aos, WhatIsOfAnotherFormIsAnError) {
  ExpectAosError("{\"images\": [", {"is not JSON"});
  ExpectAosError("[]", {"a list \"images\""});
  ExpectAosError("{}", {"a list \"images\""});
  ExpectAosError(R"({"images": []})", {"a list \"images\""});
  ExpectAosError(R"({"images": 7})", {"a list \"images\""});
  ExpectAosError(R"({"images": [7]})", {"images[0]: is not an object"});
  ExpectAosError(R"({"images": [{}]})", {"images[0]: \"imagefile\" is missing"});
  ExpectAosError(R"({"images": [{"imagefile": 3}]})", {"images[0]: \"imagefile\" is missing"});
  ExpectAosError(R"({"images": [{"imagefile": "a\u0000"}]})", {"NUL"});
  ExpectAosError(std::string(100'000, '['), {"is not JSON"});
}

TEST(Aos, BrokenMatricesAreErrorsThatNameTheImage) {
  const auto expect = [](const std::string& matrix, const std::string& part) {
    ExpectAosError(
        R"({"images": [)" + Entry("a.png", kUnturnedMatrix) + "," + Entry("b.png", matrix) + "]}",
        {"images[1] (b.png): \"M3x4\"", part});
  };
  expect("null", "3 lists of 4 numbers");
  expect("[[1,0,0,1],[0,1,0,2]]", "3 lists of 4 numbers");
  expect("[[1,0,0],[0,1,0],[0,0,1]]", "3 lists of 4 numbers");
  expect(R"([[1,0,0,"x"],[0,1,0,2],[0,0,1,3]])", "3 lists of 4 numbers");
  expect(R"([[1,0,0,"nan"],[0,1,0,2],[0,0,1,3]])", "3 lists of 4 numbers");
  expect("[[1,0,0,true],[0,1,0,2],[0,0,1,3]]", "3 lists of 4 numbers");
  expect("[[-1,0,0,1],[0,1,0,2],[0,0,1,3]]", "mirrored");
  expect("[[1,0.01,0,1],[0,1,0,2],[0,0,1,3]]", "sheared");
  expect("[[2,0,0,1],[0,2,0,2],[0,0,2,3]]", "unit length");
  expect("[[1,0,0,1e13],[0,1,0,2],[0,0,1,3]]", "(1e+13, 2, 3)");
}

class AosFolderTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    fs::create_directories(folder_ / "poses");
    path_ = folder_ / "poses" / "poses.json";
    Write("a.tiff");
  }
  void Write(const std::string& name) const {
    ASSERT_TRUE(WriteFileAtomically(path_, R"({"images": [)" + Entry(name, kUnturnedMatrix) + "," +
                                               Entry("b.tiff", kUnturnedMatrix) + "]}"));
  }
  static void WriteImageFile(const fs::path& path, int width, int height) {
    fs::create_directories(path.parent_path());
    const Image<uint8_t> image(width, height, 1);
    ASSERT_TRUE(WriteImage(path, image.view()));
  }
  std::string ErrorOf(const AosOptions& options) const {
    const Result<LightField> light_field = ReadAos(path_, options);
    EXPECT_FALSE(light_field);
    return light_field ? "" : light_field.error().message;
  }

  fs::path path_;
};

TEST_F(AosFolderTest, TheFieldOfViewIsAcrossTheWholeImage) {
  WriteImageFile(folder_ / "images" / "a.tiff", 512, 512);
  const Result<LightField> light_field = ReadAos(path_, {.fov_deg = 90});
  ASSERT_TRUE(light_field) << light_field.error().message;
  const Intrinsics& k = light_field->intrinsics.at(0);
  EXPECT_NEAR(k.fx_px, 256, 1e-10);
  EXPECT_EQ(k.fy_px, k.fx_px);
  EXPECT_EQ(k.cx_px, 256);
  EXPECT_EQ(k.width_px, 512);
  EXPECT_TRUE(fs::exists(light_field->ImagePath({0})));
  // 512 / 0.79 is the focal length of AOS's new_K for 512 pixels with the factor 0.79; AOS passes
  // this field of view to its renderer.
  const Result<LightField> f0 = ReadAos(path_, {.fov_deg = 43.10803984095769});
  EXPECT_NEAR(f0->intrinsics[0].fx_px, 512 / 0.79, 1e-9);
}

TEST_F(AosFolderTest, ImagesThatAreNotSquareHaveItAlongBothAxesAndAWarning) {
  WriteImageFile(folder_ / "images" / "a.tiff", 640, 512);
  testing::internal::CaptureStderr();
  const Result<LightField> light_field = ReadAos(path_, {.fov_deg = 90});
  const std::string warning = testing::internal::GetCapturedStderr();
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_NEAR(light_field->intrinsics[0].fx_px, 320, 1e-10);
  EXPECT_NEAR(light_field->intrinsics[0].fy_px, 256, 1e-10);
  EXPECT_NE(warning.find("640 x 512 pixels"), std::string::npos) << warning;
}

TEST_F(AosFolderTest, ImagesAreSearchedBesideAndMayBePngInsteadOfTiff) {
  WriteImageFile(folder_ / "images_ldr" / "a.png", 8, 8);
  const Result<LightField> light_field = ReadAos(path_, {.fov_deg = 50});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, (std::vector<std::string>{"a.png", "b.png"}));
  EXPECT_TRUE(fs::exists(light_field->ImagePath({0})));

  const std::string error = ErrorOf({.fov_deg = 50, .images_folder = folder_ / "elsewhere"});
  EXPECT_NE(error.find("a.tiff, is in none of the folders"), std::string::npos) << error;
  EXPECT_NE(error.find("elsewhere: give the folder of the images ({images})"), std::string::npos);
  WriteImageFile(folder_ / "elsewhere" / "a.tiff", 6, 6);
  const Result<LightField> elsewhere =
      ReadAos(path_, {.fov_deg = 50, .images_folder = folder_ / "elsewhere"});
  ASSERT_TRUE(elsewhere) << elsewhere.error().message;
  EXPECT_EQ(elsewhere->intrinsics[0].width_px, 6);
  EXPECT_EQ(elsewhere->image_names[1], "b.tiff");
}

TEST_F(AosFolderTest, MovedImagesAreFoundByTheirNames) {
  WriteImageFile(folder_ / "poses" / "thermal" / "A.png", 8, 8);
  WriteImageFile(folder_ / "poses" / "thermal" / "b.tif", 8, 8);
  for (const std::optional<fs::path>& images_folder :
       {std::optional<fs::path>(), std::optional(folder_)}) {
    const Result<LightField> light_field =
        ReadAos(path_, {.fov_deg = 50, .images_folder = images_folder});
    ASSERT_TRUE(light_field) << light_field.error().message;
    for (uint32_t i = 0; i < 2; ++i) EXPECT_TRUE(fs::exists(light_field->ImagePath({i}))) << i;
  }
}

TEST_F(AosFolderTest, WithoutAFieldOfViewItAsksForIt) {
  WriteImageFile(folder_ / "images" / "a.tiff", 8, 8);
  EXPECT_NE(ErrorOf({}).find("({fov_deg}"), std::string::npos);
  for (const double fov_deg : {0.0, -40.0, 180.0, std::nan("")}) {
    const Result<LightField> light_field = ReadAos(path_, {.fov_deg = fov_deg});
    ASSERT_FALSE(light_field);
    EXPECT_EQ(light_field.error().kind, ErrorKind::kUsage);
  }
}

TEST_F(AosFolderTest, IsKnownByItsContent) {
  EXPECT_TRUE(IsAosFile(path_));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "t.json", R"({"frames": []})"));
  EXPECT_FALSE(IsAosFile(folder_ / "t.json"));
  EXPECT_FALSE(IsAosFile(folder_ / "none.json"));
  EXPECT_FALSE(IsAosFile(folder_));
}

}  // namespace
}  // namespace lf
