// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/write_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lf/camera/path/path_yaml.h"
#include "lf/camera/path/view_cameras.h"
#include "lf/core/file.h"
#include "lf/import/paths/test_paths.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

// Expects the same bits in every member.
void ExpectSameCameras(const CameraPath& a, const CameraPath& b) {
  EXPECT_EQ(a.fps, b.fps);
  EXPECT_EQ(a.unit_m, b.unit_m);
  ASSERT_EQ(a.frame_count(), b.frame_count());
  for (size_t i = 0; i < a.frame_count(); ++i) {
    const RenderCamera &x = a.cameras[i], &y = b.cameras[i];
    EXPECT_EQ(x.pinhole.cam_from_world.rotation, y.pinhole.cam_from_world.rotation);
    EXPECT_EQ(x.pinhole.cam_from_world.translation, y.pinhole.cam_from_world.translation);
    EXPECT_EQ(x.pinhole.intrinsics, y.pinhole.intrinsics);
    EXPECT_EQ(x.aperture.radius_w, y.aperture.radius_w);
    EXPECT_EQ(x.aperture.blades, y.aperture.blades);
    EXPECT_EQ(x.aperture.rotation_rad, y.aperture.rotation_rad);
    EXPECT_EQ(x.aperture.ratio, y.aperture.ratio);
    EXPECT_EQ(x.aperture.roundness, y.aperture.roundness);
    EXPECT_EQ(x.hood.distance_w, y.hood.distance_w);
    EXPECT_EQ(x.hood.radius_w, y.hood.radius_w);
    EXPECT_EQ(x.focus_plane.normal, y.focus_plane.normal);
    EXPECT_EQ(x.focus_plane.offset_w, y.focus_plane.offset_w);
    EXPECT_EQ(x.time_s, y.time_s);
    EXPECT_EQ(x.focal_length_w, y.focal_length_w);
    EXPECT_EQ(x.sensor_width_w, y.sensor_width_w);
    EXPECT_EQ(x.focus_distance_w, y.focus_distance_w);
    EXPECT_EQ(x.focus_tilt.horizontal_rad, y.focus_tilt.horizontal_rad);
    EXPECT_EQ(x.focus_tilt.vertical_rad, y.focus_tilt.vertical_rad);
    EXPECT_EQ(x.unit_m, y.unit_m);
  }
}

// A film in which everything moves.
constexpr const char* kLivelyPath = R"(format: lfpath 1
fps: 23.976
frames: 9
unit_m: 0.3
resolution: [201, 99]
camera: {sensor_width_mm: 24, focal_length_mm: 50, focal_length_speed_mm: 7, position: [0.1, 2, -3],
         speed: [1, 0.7, 0.3], look_at: [0, 0, 1], roll_deg: 10, shift_mm: {horizontal: 1.7}}
lens: {f_number: 1.4, focus_distance: 2, focus_distance_speed: 0.3, breathing: true, blades: 7,
       ratio: 1.7, blade_roundness: 0.3, hood_distance_mm: 31, hood_diameter_mm: 77,
       blade_rotation_deg: 3, focus_tilt_deg: {horizontal: 7, vertical: -3}}
)";

class WritePathTest : public FolderTest {
 protected:
  static CameraPath Lively() {
    const Result<CameraPath> path = ParsePathYaml(kLivelyPath, "p.yaml", std::nullopt);
    EXPECT_TRUE(path) << path.error().message;
    return path ? *path : CameraPath{};
  }
  // Writes the path and reads it again. *lost gets what the format cannot hold.
  CameraPath ThereAndBack(const CameraPath& path, PathFormat format, const PathOptions& options,
                          std::vector<std::string>* lost) {
    const auto written = WritePath(path, folder_ / "written", format, options);
    EXPECT_TRUE(written) << written.error().message;
    if (written) *lost = *written;
    const Result<CameraPath> read = OpenPath(folder_ / "written", options);
    EXPECT_TRUE(read) << read.error().message;
    return read ? *read : CameraPath{};
  }
};

TEST_F(WritePathTest, JsonKeepsEveryBit) {
  const CameraPath path = Lively();
  for (const PathFormat format : {PathFormat::kNerfstudio, PathFormat::kNgp}) {
    std::vector<std::string> lost;
    ExpectSameCameras(path, ThereAndBack(path, format, {}, &lost));
    ASSERT_EQ(lost.size(), 2u);
    EXPECT_NE(lost[0].find("principal point"), std::string::npos);
    EXPECT_NE(lost[1].find(format == PathFormat::kNgp ? "tilt" : "lens"), std::string::npos);
  }
  // Another space of instant-ngp stands in the file.
  std::vector<std::string> lost;
  const PathOptions space = {.ngp_scale = 0.7, .ngp_offset = Vec3(1, 2, 3)};
  ExpectSameCameras(path, ThereAndBack(path, PathFormat::kNgp, space, &lost));
}

TEST_F(WritePathTest, NumbersOfFramesAreKept) {
  CameraPath path = Lively();
  for (const uint32_t first : {0u, 1001u, kLargestFrameNumber - 8}) {
    path.first_frame = first;
    std::vector<std::string> lost;
    for (const PathFormat format :
         {PathFormat::kYaml, PathFormat::kNerfstudio, PathFormat::kNgp, PathFormat::kChan}) {
      const CameraPath read = ThereAndBack(path, format, {}, &lost);
      EXPECT_EQ(read.first_frame, first);
      EXPECT_EQ(read.frame_count(), 9u);
      EXPECT_EQ(read.cameras.front().time_s, 0);
    }
  }
  path.first_frame = 1001;
  ASSERT_TRUE(WritePath(path, folder_ / "p.chan", PathFormat::kChan, {}));
  EXPECT_TRUE(ReadFile(folder_ / "p.chan")->starts_with("1001\t"));
  ASSERT_TRUE(WritePath(path, folder_ / "p.usda", PathFormat::kUsda, {}));
  const std::string usda = *ReadFile(folder_ / "p.usda");
  for (const char* part : {"startTimeCode = 1001\n", "endTimeCode = 1009\n", " 1001: ", " 1009: "})
    EXPECT_NE(usda.find(part), std::string::npos) << part;
  EXPECT_EQ(usda.find(" 1: "), std::string::npos);
  // The last number would have nine digits.
  ASSERT_TRUE(WritePath(path, folder_ / "p.json", PathFormat::kNerfstudio, {}));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "p.json",
                                  With(*ReadFile(folder_ / "p.json"), "\"lf_first_frame\": 1001",
                                       "\"lf_first_frame\": 99999999")));
  ExpectPathError(OpenPath(folder_ / "p.json", {}), (folder_ / "p.json").string(),
                  {"\"lf_first_frame\" is 99999999", "9 frames"});
}

TEST_F(WritePathTest, AnOffCentrePrincipalPointIsKeptAndTold) {
  CameraPath path = Lively();
  path.cameras[2].pinhole.intrinsics.cx_px += 5;
  std::vector<std::string> lost;
  ExpectSameCameras(path, ThereAndBack(path, PathFormat::kNerfstudio, {}, &lost));
  ASSERT_EQ(lost.size(), 2u);
  EXPECT_NE(lost[0].find("principal point"), std::string::npos);
}

TEST_F(WritePathTest, ViewsKeepTheirPlatesInEveryFormatThatHoldsAShift) {
  const auto views = StereoPath(Lively(), 0.2, 1.7);
  ASSERT_TRUE(views);
  std::vector<std::string> lost;
  for (const PathFormat format : {PathFormat::kNerfstudio, PathFormat::kNgp}) {
    EXPECT_TRUE(HoldsShift(format));
    const CameraPath read = ThereAndBack(*views, format, {}, &lost);
    ExpectSameCameras(*views, read);
    EXPECT_EQ(read.views, 2);
    EXPECT_NE(lost.back().find("2 views of each moment"), std::string::npos);
  }
  EXPECT_TRUE(HoldsShift(PathFormat::kYaml));
  const CameraPath again = ThereAndBack(*views, PathFormat::kYaml, {}, &lost);
  ASSERT_EQ(again.frame_count(), 18u);
  EXPECT_EQ(again.views, 2);
  for (size_t i = 0; i < 18; ++i) {
    const Intrinsics& old = views->cameras[i].pinhole.intrinsics;
    EXPECT_NEAR(again.cameras[i].pinhole.intrinsics.cx_px, old.cx_px, 1e-9);
    EXPECT_GT(std::abs(old.cx_px - 100.5), 1);
  }
  EXPECT_FALSE(HoldsShift(PathFormat::kChan));
  EXPECT_EQ(WritePath(*views, folder_ / "v.chan", PathFormat::kChan, {}).error().kind,
            ErrorKind::kUsage);
  const auto usda = WritePath(*views, folder_ / "v.usda", PathFormat::kUsda, {});
  ASSERT_TRUE(usda);
  EXPECT_NE(usda->back().find("2 views of each moment"), std::string::npos);
  EXPECT_TRUE(HoldsShift(PathFormat::kUsda));
}

TEST_F(WritePathTest, ViewsThatDoNotFitTheFramesAreRefused) {
  const auto views = StereoPath(Lively(), 0.2, 1.7);
  ASSERT_TRUE(views);
  for (const PathFormat format : {PathFormat::kNerfstudio, PathFormat::kNgp}) {
    ASSERT_TRUE(WritePath(*views, folder_ / "v.json", format, {}));
    std::string text = *ReadFile(folder_ / "v.json");
    const std::string key = "\"lf_views\": 2";
    ASSERT_NE(text.find(key), std::string::npos);
    text.replace(text.find(key), key.size(), "\"lf_views\": 4");
    ASSERT_TRUE(WriteFileAtomically(folder_ / "v.json", text));
    const auto read = OpenPath(folder_ / "v.json", {});
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("\"lf_views\" is 4, but the file has 18 frames"),
              std::string::npos)
        << read.error().message;
  }
}

TEST_F(WritePathTest, OtherProgramsFindTheirOwnKeys) {
  CameraPath path = Lively();
  path.cameras.resize(1);
  ASSERT_TRUE(WritePath(path, folder_ / "n", PathFormat::kNerfstudio, {}));
  const Result<std::string> text = ReadFile(folder_ / "n");
  ASSERT_TRUE(text);
  for (const char* part : {"\"camera_type\": \"perspective\"", "\"render_width\": 201",
                           "\"render_height\": 99", "\"lf_space\": \"world\""})
    EXPECT_NE(text->find(part), std::string::npos) << part;
}

TEST_F(WritePathTest, TheTrainedSpaceIsAppliedAndUndone) {
  const CameraPath path = Lively();
  ASSERT_TRUE(WriteFileAtomically(
      folder_ / "t.json",
      R"({"transform": [[0, -1, 0, 10], [1, 0, 0, 20], [0, 0, 1, 30]], "scale": 0.5})"));
  std::vector<std::string> lost;
  const CameraPath back = ThereAndBack(path, PathFormat::kNerfstudio,
                                       {.dataparser_transforms = folder_ / "t.json"}, &lost);
  ASSERT_EQ(back.frame_count(), path.frame_count());
  for (size_t i = 0; i < path.frame_count(); ++i) {
    const RenderCamera &a = path.cameras[i], &b = back.cameras[i];
    EXPECT_LT((a.pinhole.CentreWorld() - b.pinhole.CentreWorld()).norm(), 1e-12);
    EXPECT_LT((a.pinhole.ForwardWorld() - b.pinhole.ForwardWorld()).norm(), 1e-12);
    EXPECT_NEAR(a.focus_distance_w, b.focus_distance_w, 1e-12);
    EXPECT_NEAR(a.aperture.radius_w, b.aperture.radius_w, 1e-12);
  }
  // Without the file, the cameras are those of the trained space.
  const Result<CameraPath> trained = OpenPath(folder_ / "written", {});
  ASSERT_TRUE(trained);
  EXPECT_NEAR(trained->cameras[0].focus_distance_w, path.cameras[0].focus_distance_w / 2, 1e-12);
}

TEST_F(WritePathTest, AMovedPathSeesTheMovedScene) {
  CameraPath path = Lively();
  const RenderCamera before = path.cameras[3];
  Similarity move;
  move.scale = 2;
  move.rotation = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  move.translation = Vec3(4, 5, 6);
  ASSERT_TRUE(MovePath(move, "p", &path));
  const RenderCamera& after = path.cameras[3];
  const Vec3 point(0.2, -0.1, 1.5);
  const Vec3 moved = move.scale * (move.rotation * point) + move.translation;
  EXPECT_LT((*Project(before.pinhole, point) - *Project(after.pinhole, moved)).norm(), 1e-9);
  EXPECT_NEAR(before.focus_plane.normal.dot(point) - before.focus_plane.offset_w,
              (after.focus_plane.normal.dot(moved) - after.focus_plane.offset_w) / 2, 1e-9);
  EXPECT_EQ(after.aperture.radius_w, 2 * before.aperture.radius_w);
  move.scale = 1e10;
  ExpectPathError(MovePath(move, "p", &path), "p", {"frame 1", "reduce"});
}

TEST_F(WritePathTest, PathsReplacePathsAlone) {
  const auto file = folder_ / "written";
  EXPECT_TRUE(CheckReplacesPath(file)) << "no file is there";
  for (const PathFormat format : {PathFormat::kYaml, PathFormat::kNerfstudio, PathFormat::kNgp,
                                  PathFormat::kChan, PathFormat::kUsda}) {
    ASSERT_TRUE(WritePath(Lively(), file, format, {}));
    EXPECT_TRUE(CheckReplacesPath(file)) << NameOf(format);
  }
  for (const char* const text : {R"({"frames": []})", R"({"transform": []})", "1\na.png 1 0 0\n",
                                 "#usda 1.0\ndef Xform \"house\" {}\n", "key: value\n"}) {
    ASSERT_TRUE(WriteFileAtomically(file, text));
    const Result<void> checked = CheckReplacesPath(file);
    ASSERT_FALSE(checked) << text;
    EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
    EXPECT_NE(checked.error().message.find("is not a camera path"), std::string::npos);
  }
  ASSERT_TRUE(WriteFileAtomically(file, ""));
  EXPECT_TRUE(CheckReplacesPath(file));
}

TEST(PathFormat, ExtensionsAndNames) {
  EXPECT_EQ(PathFormatOfFile("a/b.yml"), PathFormat::kYaml);
  EXPECT_EQ(PathFormatOfFile("b.json"), PathFormat::kNerfstudio);
  EXPECT_EQ(PathFormatOfFile("b.chan"), PathFormat::kChan);
  EXPECT_EQ(PathFormatOfFile("b.usda"), PathFormat::kUsda);
  EXPECT_EQ(PathFormatOfFile("yaml"), std::nullopt);
  EXPECT_EQ(PathFormatOf("instant-ngp"), PathFormat::kNgp);
  EXPECT_EQ(PathFormatOf("ngp"), std::nullopt);
}

}  // namespace
}  // namespace lf
