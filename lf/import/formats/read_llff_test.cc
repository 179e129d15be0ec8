// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_llff.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

using RowNumbers = std::array<double, 17>;

// A camera at (1, 2, 3) that is not rotated: right is x, down is y, forward is z. 640 x 480 pixels.
constexpr RowNumbers kUnturned = {0,   1, 0,  1, 480,  //
                                  1,   0, 0,  2, 640,  //
                                  0,   0, -1, 3, 500,  //
                                  0.5, 20};

std::string NpyOfRows(const std::vector<RowNumbers>& rows) {
  const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" +
                             std::to_string(rows.size()) + ", 17), }\n";
  std::string bytes = std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(header.size()) + '\0';
  bytes += header;
  std::string values(rows.size() * sizeof(RowNumbers), '\0');
  std::memcpy(values.data(), rows.data(), values.size());
  return bytes + values;
}

Result<std::array<int, 2>> SizeOfImage0(const fs::path& image) {
  EXPECT_EQ(image, "data/images/0.png");
  return std::array{640, 480};
}

Result<LightField> Parse(const std::vector<RowNumbers>& rows) {
  std::vector<std::string> names;
  for (size_t i = 0; i < rows.size(); ++i) names.push_back(std::to_string(i) + ".png");
  return ParseLlff(NpyOfRows(rows), "data/poses_bounds.npy", names, SizeOfImage0);
}

void ExpectLlffError(const Result<LightField>& light_field, const std::vector<std::string>& parts) {
  ASSERT_FALSE(light_field);
  const std::string& message = light_field.error().message;
  EXPECT_EQ(message.find("data/poses_bounds.npy: "), 0u) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

TEST(Llff, ReadsPoseIntrinsicsAndDepths) {
  RowNumbers second = kUnturned;
  second[15] = 0.25;
  second[16] = 10;
  const Result<LightField> light_field = Parse({kUnturned, second});
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, (std::vector<std::string>{"images/0.png", "images/1.png"}));
  EXPECT_EQ(light_field->folder, "data");
  EXPECT_EQ(light_field->intrinsics,
            std::vector<Intrinsics>{(Intrinsics{500, 500, 320, 240, 0, 640, 480})});
  EXPECT_EQ(light_field->cameras[0].cam_from_world.rotation, Mat3::Identity());
  EXPECT_EQ(light_field->Camera({0}).CentreWorld(), Vec3(1, 2, 3));
  EXPECT_EQ(light_field->depth_range, (DepthRange{0.25, 20}));
}

// NeRF's loader turns the columns [down, right, backwards] into OpenGL's [right, up, backwards] =
// [column 1, -column 0, column 2].
TEST(Llff, ColumnsAreTheAxesDownRightBackwards) {
  const Mat3 axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, -3).normalized()).toRotationMatrix();
  RowNumbers row = kUnturned;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) row[5 * i + k] = axes(i, k);
  const Result<LightField> light_field = Parse({row});
  ASSERT_TRUE(light_field) << light_field.error().message;
  const PinholeCamera camera = light_field->Camera({0});
  EXPECT_LT((camera.RightWorld() - axes.col(1)).norm(), 1e-15);
  EXPECT_LT((camera.UpWorld() + axes.col(0)).norm(), 1e-15);
  EXPECT_LT((camera.ForwardWorld() + axes.col(2)).norm(), 1e-15);
  EXPECT_LT((camera.CentreWorld() - Vec3(1, 2, 3)).norm(), 1e-15);
}

TEST(Llff, CountsMustAgreeWithTheImages) {
  const std::vector<std::string> names = {"0.png", "1.png", "2.png"};
  ExpectLlffError(
      ParseLlff(NpyOfRows({kUnturned, kUnturned}), "data/poses_bounds.npy", names, SizeOfImage0),
      {"holds 2 poses", "data/images holds 3 image files"});
  std::string wide = NpyOfRows({kUnturned});
  wide.replace(wide.find("(1, 17)"), 7, "(17, 1)");
  ExpectLlffError(ParseLlff(wide, "data/poses_bounds.npy", names, SizeOfImage0),
                  {"the shape (17, 1): expected (N, 17)"});
  ExpectLlffError(ParseLlff("x", "data/poses_bounds.npy", names, SizeOfImage0),
                  {"is no .npy file"});
}

TEST(Llff, ImagesOfAnotherSizeAreAnErrorThatNamesBoth) {
  const auto other = [](const fs::path&) -> Result<std::array<int, 2>> {
    return std::array{80, 70};
  };
  const std::vector<std::string> names = {"0.png"};
  ExpectLlffError(ParseLlff(NpyOfRows({kUnturned}), "data/poses_bounds.npy", names, other),
                  {"640 x 480", "data/images/0.png has 80 x 70", "columns 4, 9 and 14"});
}

TEST(Llff, BrokenRowsAreErrorsThatNameTheRow) {
  const auto expect = [](size_t index, double value, const std::vector<std::string>& parts) {
    RowNumbers row = kUnturned;
    row[index] = value;
    std::vector<std::string> all = parts;
    all.push_back("row 1 (1.png): ");
    ExpectLlffError(Parse({kUnturned, row}), all);
  };
  expect(0, std::numeric_limits<double>::quiet_NaN(), {"not finite"});
  expect(3, 1e13, {"beyond +-1e+12"});
  expect(0, 0.01, {"the pose, whose columns are the axes down, right and backwards, is sheared"});
  expect(12, 1, {"backwards, is mirrored"});
  expect(4, 480.5, {"height and width are 480.5 and 640"});
  expect(9, 0, {"480 and 0"});
  expect(9, 1e9, {"1 to 65536"});
  expect(14, -500, {"the focal length is -500"});
  expect(15, 0, {"bounds are 0 and 20"});
  expect(16, 0.5, {"bounds are 0.5 and 0.5"});
  expect(16, std::numeric_limits<double>::infinity(), {"0 < near < far"});
}

class LlffFolderTest : public FolderTest {};

TEST_F(LlffFolderTest, TakesTheSortedImagesBeside) {
  const fs::path path = folder_ / "poses_bounds.npy";
  RowNumbers second = kUnturned;
  second[3] = 7;
  ASSERT_TRUE(WriteFileAtomically(path, NpyOfRows({kUnturned, second})));
  const Result<LightField> without = ReadLlff(path);
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().message.find("images: cannot be listed"), std::string::npos);
  fs::create_directories(folder_ / "images");
  const Image<uint8_t> image(640, 480, 3);
  for (const char* name : {"b.JPG", "a.png"})
    ASSERT_TRUE(WriteImage(folder_ / "images" / name, image.view()));
  const Result<LightField> light_field = ReadLlff(path);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, (std::vector<std::string>{"images/a.png", "images/b.JPG"}));
  EXPECT_EQ(light_field->Camera({1}).CentreWorld(), Vec3(7, 2, 3));
  EXPECT_TRUE(fs::exists(light_field->ImagePath({1})));
}

TEST_F(LlffFolderTest, FindsTheFolderThatHoldsAnImageForEachRow) {
  const fs::path path = folder_ / "poses_bounds.npy";
  ASSERT_TRUE(WriteFileAtomically(path, NpyOfRows({kUnturned, kUnturned})));
  const auto add = [&](const char* name, int width, int height) {
    fs::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(WriteImage(folder_ / name, Image<uint8_t>(width, height, 3).view()));
  };
  const auto first = [&](const std::optional<fs::path>& images_folder = {}) {
    const Result<LightField> light_field = ReadLlff(path, images_folder);
    return light_field ? light_field->ImagePath({0}).string() : light_field.error().message;
  };
  add("masks/a.png", 640, 480);
  add("masks/b.png", 640, 480);
  EXPECT_NE(first().find("images: cannot be listed"), std::string::npos);
  add("rgb/a.png", 160, 120);
  add("rgb/b.png", 160, 120);
  EXPECT_EQ(first(), folder_ / "rgb/a.png");
  add("images_16/a.png", 40, 30);
  add("images_16/b.png", 40, 30);
  EXPECT_EQ(first(), folder_ / "images_16/a.png");
  add("images_4/a.png", 160, 120);
  add("images_4/b.png", 160, 120);
  add("images/a.png", 640, 480);  // one image of two
  EXPECT_EQ(first(), folder_ / "images_4/a.png");
  add("images/b.png", 640, 480);
  EXPECT_EQ(first(), folder_ / "images/a.png");
  EXPECT_EQ(first(folder_ / "images_16"), folder_ / "images_16/a.png");
}

}  // namespace
}  // namespace lf
