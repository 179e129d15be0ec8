// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_tum.h"

#include <cmath>

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

// The camera is turned by a quarter about its axis, and moves by (1, 0, 0) within 0.1 s.
const std::string kTum = R"(# timestamp tx ty tz qx qy qz qw
10.0 1 2 3 0 0 0.70710678118654757 0.70710678118654757
10.1 2 2 3 0 0 0.70710678118654757 0.70710678118654757
20.0 9 9 9 0 0 0 1
)";

Result<ExportedCameras> ParseTumTrack(const std::string& text, const std::string& list) {
  return ParseTum(text, "f/groundtruth.txt", list, "f/rgb.txt", 100);
}

TEST(Tum, ReadsThePoseOfTheTimeOfAnImage) {
  const Result<ExportedCameras> cameras = ParseTumTrack(
      kTum, "# time name\n10.0 rgb/a.png\n10.05 rgb/b.png\n15 rgb/c.png\n20.015 rgb/d.png\n");
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 3u);  // no pose is near the third
  EXPECT_TRUE(cameras->counts_from_middle);
  EXPECT_EQ(cameras->images[2].name, "rgb/d.png");
  // The camera's right is the world's y, its down is the world's -x.
  ExpectNear(PixelOf(cameras->images[0], {0, 3, 5}), {50, 50});
  ExpectNear(PixelOf(cameras->images[1], {0.5, 3, 5}), {50, 50});
  ExpectNear(PixelOf(cameras->images[2], {10, 9, 11}), {50, 0});
}

TEST(Tum, NamesWhatIsWrong) {
  const std::string list = "10 a.png\n";
  ExpectFault(ParseTumTrack(Replaced(kTum, "10.1", "9"), list), "the time 9 is not later than");
  ExpectFault(ParseTumTrack(Replaced(kTum, "9 9 9", "9 nan 9"), list), "time x y z qx qy qz qw");
  ExpectFault(ParseTumTrack(Replaced(kTum, "0 0 0 1", "0 0 0 2"), list), "has the length 2");
  ExpectFault(ParseTumTrack(Replaced(kTum, "0 0 0 1", "0"), list), "has fewer than 8 numbers");
  ExpectFault(ParseTumTrack(Replaced(kTum, "0 0 0 1", "0 0 0 1 2"), list),
              "has more than 8 numbers");
  ExpectFault(ParseTumTrack(kTum, "10\n"), "f/rgb.txt:1: expected a time and a name");
}

using TumFolder = FolderTest;

TEST_F(TumFolder, NeedsAListAndAFocalLength) {
  const std::filesystem::path file = folder_ / "groundtruth.txt";
  ASSERT_TRUE(WriteFileAtomically(file, kTum));
  ExportOptions options = {.image_size = [](const std::filesystem::path&) {
    return Result(std::array{640, 480});
  }};
  EXPECT_NE(ReadTum(file, options).error().message.find("rgb.txt"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "rgb.txt", "10 rgb/a.png\n"));
  EXPECT_NE(ReadTum(file, options).error().message.find("{focal_px"), std::string::npos);
  options.focal_px = 525;
  const Result<LightField> light_field = ReadTum(file, options);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->intrinsics[0].cx_px, 320);
  EXPECT_EQ(light_field->intrinsics[0].fy_px, 525);
}

}  // namespace
}  // namespace lf
