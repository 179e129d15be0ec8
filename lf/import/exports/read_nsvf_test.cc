// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_nsvf.h"

#include "lf/core/file.h"
#include "lf/import/exports/test_exports.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

const std::string kNsvfPose = "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n";

TEST(Nsvf, TurnsFromCameraToWorldAndCountsPixelCentresByWholeNumbers) {
  const Result<RigidTransform> pose = ParseNsvfPose(kNsvfPose, "f/pose/0.txt");
  ASSERT_TRUE(pose) << pose.error().message;
  for (const char* const text :
       {"100 0 50 0\n0 100 25 0\n0 0 1 0\n0 0 0 1\n", "100 0 50\n0 100 25\n0 0 1\n",
        "100 50 25 0.\n0. 0. 0.\n1.\n100 50\n"}) {
    const Result<Intrinsics> intrinsics = ParseNsvfIntrinsics(text, "f/intrinsics.txt");
    ASSERT_TRUE(intrinsics) << intrinsics.error().message;
    ExpectNear(PixelOf({"0.png", *intrinsics, *pose}, {0, 3, 5}), {50.5 + 50, 25.5 + 50});
  }
}

TEST(Nsvf, NamesWhatIsWrong) {
  const auto pose = [](const std::string& text) { return ParseNsvfPose(text, "f/pose/0.txt"); };
  ExpectFault(pose("1 2 3"), "has 3 numbers: expected a matrix of 4 x 4");
  ExpectFault(pose(Replaced(kNsvfPose, "0 0 0 1", "0 0 0 2")), "whose last row is 0 0 0 1");
  ExpectFault(pose(Replaced(kNsvfPose, "0 -1 0 1", "0 1 0 1")), "is mirrored");
  ExpectFault(pose(Replaced(kNsvfPose, "0 -1 0 1", "0 -1 0 nan")), "a number of the matrix");
  const auto k = [](const std::string& text) {
    return ParseNsvfIntrinsics(text, "f/intrinsics.txt");
  };
  ExpectFault(k("100"), "has 1 numbers: expected a matrix");
  ExpectFault(k("100 0 50\n1 100 25\n0 0 1\n"), "the matrix is no K");
}

using NsvfFolder = FolderTest;

TEST_F(NsvfFolder, HasAsManyImagesAsPoses) {
  for (const char* const name : {"pose/0_a.txt", "pose/1_b.txt"}) {
    ASSERT_TRUE(CreateFolder((folder_ / name).parent_path()));
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, kNsvfPose));
  }
  ASSERT_TRUE(WriteFileAtomically(folder_ / "intrinsics.txt", "100 50 25 0.\n"));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "near_and_far.txt", "0.5 6\n"));
  ASSERT_TRUE(CreateFolder(folder_ / "rgb"));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "rgb" / "0.png", "x"));
  const ExportOptions options = {.image_size = [](const std::filesystem::path&) {
    return Result(std::array{100, 50});
  }};
  const Result<LightField> without = ReadNsvf(folder_ / "pose" / "0_a.txt", options);
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().message.find("holds 1 images, but"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "rgb" / "1.png", "x"));
  const Result<LightField> light_field = ReadNsvf(folder_ / "pose" / "0_a.txt", options);
  ASSERT_TRUE(light_field) << light_field.error().message;
  EXPECT_EQ(light_field->image_names, (std::vector<std::string>{"0.png", "1.png"}));
  EXPECT_EQ(light_field->depth_range, (DepthRange{0.5, 6}));
}

}  // namespace
}  // namespace lf
