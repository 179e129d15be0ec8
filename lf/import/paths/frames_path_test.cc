// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/frames_path.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/import/paths/test_paths.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

// The camera of kNerfstudioText, with another size and focal lengths.
const std::string kSplatText =
    R"([{"id": 0, "img_name": "a", "width": 200, "height": 100, "position": [1, 2, 3],
"rotation": [[1, 0, 0], [0, 0, 1], [0, -1, 0]], "fx": 120, "fy": 110}])";

// A transforms.json of that camera, with an off-centre principal point and distortion.
const std::string kTransformsText =
    R"({"fl_x": 120, "fl_y": 110, "cx": 90, "cy": 60, "w": 200, "h": 100,
"camera_model": "OPENCV", "k1": 0.1, "lf_unit_m": 0.5, "lf_depth_range": [2, 6],
"frames": [{"file_path": "a.png",
"transform_matrix": [[1, 0, 0, 1], [0, 0, -1, 2], [0, 1, 0, 3], [0, 0, 0, 1]]}]})";

void ExpectTheCamera(const PinholeCamera& camera) {
  EXPECT_LT((camera.CentreWorld() - Vec3(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((camera.ForwardWorld() - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((camera.UpWorld() - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_EQ(camera.intrinsics.fx_px, 120);
  EXPECT_EQ(camera.intrinsics.fy_px, 110);
  EXPECT_EQ(camera.intrinsics.width_px, 200);
  EXPECT_FALSE(camera.intrinsics.has_distortion());
}

Result<ForeignPath> ParsedSplat(const std::string& text) {
  return ParseSplatCameras(text, "cameras.json", {});
}

TEST(SplatCameras, PositionAndAxesAreThoseOfTheCamera) {
  const Result<ForeignPath> path = ParsedSplat(kSplatText);
  ASSERT_TRUE(path) << path.error().message;
  ASSERT_EQ(path->cameras.size(), 1u);
  ExpectTheCamera(path->cameras[0].pinhole);
  EXPECT_EQ(path->cameras[0].pinhole.intrinsics.cx_px, 100);
}

TEST(SplatCameras, ErrorsNameTheCameraTheValueAndTheRemedy) {
  const auto expect = [](const std::string& from, const std::string& to,
                         const std::vector<std::string>& parts) {
    ExpectPathError(ParsedSplat(With(kSplatText, from, to)), "cameras.json", parts);
  };
  expect("\"fx\": 120", "\"fx\": 0", {"cameras[0]: \"fx\" is 0", "pixels above 0"});
  expect("\"position\"", "\"place\"", {"\"position\" is missing"});
  expect("[0, -1, 0]", "[0, 1, 0]", {"cameras[0]: \"rotation\""});
  expect("\"width\": 200", "\"width\": 200.5", {"\"width\" is 200.5"});
  expect("\"width\": 200, \"height\": 100", "\"width\": 65536, \"height\": 65536",
         {"65536 x 65536 pixels"});
  expect("[1, 2, 3]", "[1, 2]", {"\"position\" is [1,2]"});
  expect("}]", "}", {"is not JSON"});
  ExpectPathError(ParsedSplat("[]"), "cameras.json", {"holds no objects"});
}

TEST(SplatCameras, ImagesOfDifferentSizesNeedAResolution) {
  std::string two = kSplatText;
  two.back() = ',';
  two += With(With(kSplatText, "[{", "{"), "\"width\": 200", "\"width\": 100");
  ExpectPathError(ParsedSplat(two), "cameras.json",
                  {"camera 2 has 100 x 100 pixels", "{lfpath resolution}"});
  const PathOptions options = {.resolution_px = std::array<int, 2>{100, 50}};
  Result<ForeignPath> read = ParseSplatCameras(two, "cameras.json", options);
  ASSERT_TRUE(read) << read.error().message;
  Result<CameraPath> path = CompletePath(*std::move(read), "cameras.json", options);
  ASSERT_TRUE(path);
  ASSERT_TRUE(ReplaceQuantities(options, "cameras.json", &*path));
  for (const RenderCamera& camera : path->cameras)
    EXPECT_EQ(camera.pinhole.intrinsics.width_px, 100);
  EXPECT_EQ(path->cameras[0].pinhole.intrinsics.fx_px, 60);
  EXPECT_EQ(path->cameras[1].pinhole.intrinsics.fx_px, 120);
}

class FramesFileTest : public FolderTest {
 protected:
  void Write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, text));
  }
  RenderCamera CameraIn(const std::string& name) {
    const Result<CameraPath> path = OpenPath(folder_ / name, {});
    if (!path) ADD_FAILURE() << path.error().message;
    return path ? path->Camera({1}) : RenderCamera{};
  }
};

TEST_F(FramesFileTest, TheCamerasOfATransformsJsonAreFrames) {
  Write("transforms.json", kTransformsText);
  for (const char* name : {"transforms.json", ""}) {
    const RenderCamera camera = CameraIn(name);
    ExpectTheCamera(camera.pinhole);
    EXPECT_EQ(camera.pinhole.intrinsics.cx_px, 90);
    EXPECT_EQ(camera.pinhole.intrinsics.cy_px, 60);
    EXPECT_EQ(camera.unit_m, 0.5);
    EXPECT_NEAR(camera.focus_distance_w, 3, 1e-12);  // 2 / (1 / 2 + 1 / 6)
    EXPECT_EQ(camera.aperture.radius_w, 0);
  }
}

TEST_F(FramesFileTest, TheImagesOfAColmapModelAreFrames) {
  Write("model/sparse/0/cameras.txt", "1 PINHOLE 200 100 120 110 90 60\n");
  // The quaternion w x y z of the rotation that makes the axes x, z, -y of the world.
  Write("model/sparse/0/images.txt",
        "1 0.7071067811865476 0.7071067811865476 0 0 -1 3 -2 1 a.png\n\n");
  Write("model/sparse/0/points3D.txt", "");
  const RenderCamera camera = CameraIn("model");
  ExpectTheCamera(camera.pinhole);
  EXPECT_EQ(camera.pinhole.intrinsics.cy_px, 60);
}

TEST_F(FramesFileTest, AFolderWithoutCamerasIsAnError) {
  ExpectPathError(OpenPath(folder_, {}), folder_.string(), {"holds no camera path", "COLMAP"});
}

TEST_F(FramesFileTest, CamerasOfGaussianSplattingAreFoundByTheirKeys) {
  Write("cameras.json", kSplatText);
  ExpectTheCamera(CameraIn("cameras.json").pinhole);
}

}  // namespace
}  // namespace lf
