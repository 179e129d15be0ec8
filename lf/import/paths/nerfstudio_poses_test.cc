// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/nerfstudio_poses.h"

#include <gtest/gtest.h>

#include <string>

#include "lf/core/file.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/test_paths.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

// The camera of kNerfstudioText.
const std::string kPoses = R"([
    {"file_path": "images/a.png",
     "transform": [[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, -1.0, 2.0], [0.0, 1.0, 0.0, 3.0]]},
    {"file_path": "images/b.png",
     "transform": [[1.0, 0.0, 0.0, 2.0], [0.0, 0.0, -1.0, 2.0], [0.0, 1.0, 0.0, 3.0]]}])";

TEST(NerfstudioPoses, EachIsAFrameWithTheViewOfALens) {
  const Result<ForeignPath> path = ParseNerfstudioPoses(
      kPoses, "t.json", {.resolution_px = std::array<int, 2>{360, 200}, .fps = 24});
  ASSERT_TRUE(path) << path.error().message;
  ASSERT_EQ(path->cameras.size(), 2u);
  const PinholeCamera& camera = path->cameras[0].pinhole;
  EXPECT_EQ(camera.CentreWorld(), Vec3(1, 2, 3));
  EXPECT_EQ(camera.ForwardWorld(), Vec3(0, 1, 0));
  EXPECT_EQ(path->cameras[1].pinhole.CentreWorld(), Vec3(2, 2, 3));
  EXPECT_NEAR(camera.intrinsics.fx_px, 500, 1e-9);  // 50 mm on 36 mm
  ASSERT_EQ(path->lacks.size(), 1u);
  EXPECT_NE(path->lacks[0].find("no field of view"), std::string::npos);
  const Result<ForeignPath> wide = ParseNerfstudioPoses(
      kPoses, "t.json", {.resolution_px = std::array<int, 2>{360, 200}, .focal_length_mm = 18});
  EXPECT_NEAR(wide->cameras[0].pinhole.intrinsics.fx_px, 180, 1e-9);
}

TEST(NerfstudioPoses, MayBeginWithAByteOrderMark) {
  const Result<ForeignPath> path = ParseNerfstudioPoses("\xEF\xBB\xBF" + kPoses, "t.json", {});
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(path->cameras.size(), 2u);
}

TEST(NerfstudioPoses, ErrorsNameThePose) {
  const auto error = [](const std::string& from, const std::string& to, const char* part) {
    ExpectPathError(ParseNerfstudioPoses(With(kPoses, from, to), "t.json", {}), "t.json", {part});
  };
  error("[1.0, 0.0, 0.0, 2.0]", "[1.0, 0.0, 2.0]", "poses[1]: \"transform\"");
  error("[1.0, 0.0, 0.0, 1.0]", "[-1.0, 0.0, 0.0, 1.0]", "poses[0]: \"transform\"");
  error("\"transform\"", "\"matrix\"", "poses[0]: \"transform\" is missing");
}

using NerfstudioPosesFileTest = FolderTest;

TEST_F(NerfstudioPosesFileTest, AreFoundByTheirContentAndMovedFromTheTrainedSpace) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "transforms_eval.json", kPoses));
  const auto centre = [&] {
    const Result<CameraPath> path =
        OpenPath(folder_ / "transforms_eval.json", {.focal_length_mm = 30});
    EXPECT_TRUE(path) << path.error().message;
    return path ? path->cameras[0].pinhole.CentreWorld() : Vec3(0, 0, 0);
  };
  EXPECT_EQ(centre(), Vec3(1, 2, 3));
  ASSERT_TRUE(WriteFileAtomically(
      folder_ / "dataparser_transforms.json",
      R"({"transform": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1]], "scale": 0.5})"));
  EXPECT_LT((centre() - Vec3(2, 4, 5)).norm(), 1e-12);
}

}  // namespace
}  // namespace lf
