// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_middlebury.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

Result<std::array<int, 2>> Size640(const fs::path& image) {
  EXPECT_EQ(image, "data/a.png");
  return std::array{640, 480};
}

LightField ParsedMiddlebury(const std::string& text) {
  Result<LightField> light_field = ParseMiddlebury(text, "data/x_par.txt", Size640);
  EXPECT_TRUE(light_field) << light_field.error().message << "\n" << text;
  return light_field ? *std::move(light_field) : LightField{};
}

void ExpectMiddleburyError(const std::string& text, const std::vector<std::string>& parts) {
  const Result<LightField> light_field = ParseMiddlebury(text, "data/x_par.txt", Size640);
  ASSERT_FALSE(light_field) << text;
  const std::string& message = light_field.error().message;
  EXPECT_EQ(message.find("data/x_par.txt: "), 0u) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

const std::string kK = " 500 0.25 320 0 510 240 0 0 1";
const std::string kR = " 1 0 0 0 1 0 0 0 1";
const std::string kLine = "a.png" + kK + kR + " 1 2 3\n";

TEST(Middlebury, ReadsKAndPose) {
  const LightField light_field =
      ParsedMiddlebury("2\n" + kLine + "\n  b/c.png" + kK + " 0 -1 0 1 0 0 0 0 1\t0 0 -5e-1\r\n\n");
  ASSERT_EQ(light_field.size(), 2u);
  EXPECT_EQ(light_field.image_names, (std::vector<std::string>{"a.png", "b/c.png"}));
  EXPECT_EQ(light_field.folder, "data");
  EXPECT_EQ(light_field.intrinsics,
            std::vector<Intrinsics>{(Intrinsics{500, 510, 320.5, 240.5, 0.25, 640, 480})});
  EXPECT_EQ(light_field.cameras[0].cam_from_world * Vec3(10, 20, 30), Vec3(11, 22, 33));
  EXPECT_EQ(light_field.cameras[1].cam_from_world * Vec3(10, 20, 30), Vec3(-20, 10, 29.5));
  EXPECT_EQ(light_field.Camera({1}).CentreWorld(), Vec3(0, 0, 0.5));
  EXPECT_EQ(light_field.unit_m, 1);
}

TEST(Middlebury, AnyFactorOfKIsDividedOut) {
  const Intrinsics k =
      ParsedMiddlebury("1\na.png -1000 0 0 0 -1000 0 0 0 -2" + kR + " 0 0 0\n").intrinsics[0];
  EXPECT_EQ(k, (Intrinsics{500, 500, 0.5, 0.5, 0, 640, 480}));
}

TEST(Middlebury, ARotationOfSixDigitsIsOneAgain) {
  const LightField light_field =
      ParsedMiddlebury("1\na.png" + kK +
                       " 0.936293 -0.275096 0.218351 0.289629 0.956425 -0.036957 "
                       "-0.198669 0.097843 0.975170 0 0 0\n");
  const Mat3& rotation = light_field.cameras[0].cam_from_world.rotation;
  EXPECT_LT((rotation * rotation.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_NEAR(rotation(0, 1), -0.275096, 1e-6);
}

TEST(Middlebury, CountsThatDisagreeAreErrors) {
  ExpectMiddleburyError("", {"the file is empty", "number of images"});
  ExpectMiddleburyError(" \n\n", {"the file is empty"});
  ExpectMiddleburyError(kLine, {"line 1: \"a.png 500", "number of images alone"});
  ExpectMiddleburyError("2 3\n" + kLine, {"line 1: \"2 3\""});
  ExpectMiddleburyError("1.5\n" + kLine, {"\"1.5\""});
  ExpectMiddleburyError("0\n", {"the number of images is 0"});
  ExpectMiddleburyError("99999999999\n" + kLine, {"expected 1 to 16777216"});
  ExpectMiddleburyError("2\n" + kLine, {"holds 1 lines of images, but its first line states 2"});
  ExpectMiddleburyError("1\n" + kLine + kLine,
                        {"line 3: the file holds more lines of images than the 1"});
}

TEST(Middlebury, BrokenLinesAreErrorsThatNameTheLine) {
  const auto expect = [](const std::string& line, const std::vector<std::string>& parts) {
    std::vector<std::string> all = parts;
    all.push_back("line 3: ");
    ExpectMiddleburyError("2\n" + kLine + line + "\n", all);
  };
  expect("b.png 1 2 3", {"4 of 21 is missing", "NAME k11 k12"});
  expect("b.png" + kK + kR + " 1 2 3 4", {"the last number is followed by \"4\""});
  expect("my b.png" + kK + kR + " 1 2 3", {"1 of 21 is \"b.png\""});
  expect("b.png" + kK + kR + " 1 nan 3", {"20 of 21 is \"nan\""});
  expect(std::string("b\0.png", 6) + kK + kR + " 1 2 3", {"NUL"});
  expect("b.png 500 0 320 0 510 240 0 0 0" + kR + " 1 2 3", {"b.png: k33 is 0"});
  expect("b.png 500 0 320 1 510 240 0 0 1" + kR + " 1 2 3", {"below the diagonal of K"});
  expect("b.png -500 0 320 0 510 240 0 0 1" + kR + " 1 2 3", {"focal lengths", "-500 and 510"});
  expect("b.png 500 0 1e9 0 510 240 0 0 1" + kR + " 1 2 3", {"expected -1e7 to 1e7"});
  expect("b.png" + kK + " 1 0 0 0 1 0 0 0 -1 1 2 3", {"b.png: R is mirrored"});
  expect("b.png" + kK + " 1 0.001 0 0 1 0 0 0 1 1 2 3", {"R is sheared"});
  expect("b.png" + kK + " 2 0 0 0 2 0 0 0 2 1 2 3", {"R is sheared or scaled"});
  expect("b.png" + kK + kR + " 1 2 1e13", {"t is (1, 2, 1"});
}

class MiddleburyFolderTest : public FolderTest {};

TEST_F(MiddleburyFolderTest, TheFirstImageTellsTheSize) {
  const fs::path path = folder_ / "x_par.txt";
  ASSERT_TRUE(WriteFileAtomically(path, "1\n" + kLine));
  const Result<LightField> without = ReadMiddlebury(path);
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().message.find("a.png"), std::string::npos);
  const Image<uint8_t> image(36, 20, 3);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", image.view()));
  const Result<LightField> light_field = ReadMiddlebury(path);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->intrinsics[0].width_px, 36);
  EXPECT_EQ(light_field->intrinsics[0].height_px, 20);
  EXPECT_EQ(MiddleburyFiles(folder_), std::vector<fs::path>{path});
}

}  // namespace
}  // namespace lf
