// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/nerfstudio_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/test_paths.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

Result<ForeignPath> ParsedNerfstudio(const std::string& text, const PathOptions& options = {}) {
  bool is_world = false;
  return ParseNerfstudioPath(text, "n.json", options, &is_world);
}

void ExpectNerfstudioError(const std::string& from, const std::string& to,
                           const std::vector<std::string>& parts) {
  ExpectPathError(ParsedNerfstudio(With(kNerfstudioText, from, to)), "n.json", parts);
}

TEST(NerfstudioPath, CamerasAreConvertedFromOpenGlAndVerticalAngles) {
  const Result<ForeignPath> path = ParsedNerfstudio(kNerfstudioText);
  ASSERT_TRUE(path) << path.error().message;
  ASSERT_EQ(path->cameras.size(), 1u);
  EXPECT_EQ(path->fps, 10);
  const PinholeCamera& camera = path->cameras[0].pinhole;
  EXPECT_EQ(camera.CentreWorld(), Vec3(1, 2, 3));
  EXPECT_EQ(camera.ForwardWorld(), Vec3(0, 1, 0));
  EXPECT_EQ(camera.UpWorld(), Vec3(0, 0, 1));
  EXPECT_NEAR(camera.intrinsics.fy_px, 50, 1e-12);  // half of 100 elements at half of 90 degrees
  EXPECT_EQ(camera.intrinsics.cx_px, 100);
  EXPECT_EQ(camera.intrinsics.cy_px, 50);
  EXPECT_FALSE(path->cameras[0].aperture_diameter_w);
}

TEST(NerfstudioPath, MatricesMayBeListsOfRowsAndLackTheLast) {
  const std::string flat = "[1, 0, 0, 1, 0, 0, -1, 2, 0, 1, 0, 3, 0, 0, 0, 1]";
  for (const char* matrix :
       {"[[1, 0, 0, 1], [0, 0, -1, 2], [0, 1, 0, 3], [0, 0, 0, 1]]",
        "[[1, 0, 0, 1], [0, 0, -1, 2], [0, 1, 0, 3]]", "[1, 0, 0, 1, 0, 0, -1, 2, 0, 1, 0, 3]"}) {
    const Result<ForeignPath> path = ParsedNerfstudio(With(kNerfstudioText, flat, matrix));
    ASSERT_TRUE(path) << path.error().message;
    EXPECT_EQ(path->cameras[0].pinhole.CentreWorld(), Vec3(1, 2, 3));
    EXPECT_EQ(path->cameras[0].pinhole.ForwardWorld(), Vec3(0, 1, 0));
  }
  ExpectNerfstudioError(flat, "[[1, 0, 0, 1], [0, 0, -1, 2], [0, 1, 0, 3], [1, 2, 3, 1]]",
                        {"last row 1, 2, 3, 1"});
  ExpectNerfstudioError(flat, "[[1, 0, 0], [0, 0, -1], [0, 1, 0]]",
                        {"camera_path[0]: \"camera_to_world\"", "4 numbers"});
}

TEST(NerfstudioPath, AFieldOfViewThatMayBeInRadiansIsNoted) {
  const std::string text = With(kNerfstudioText, "90", "0.87");
  EXPECT_EQ(ParsedNerfstudio(text)->largest_fov, 0.87);
  const Result<ForeignPath> radians = ParsedNerfstudio(text, {.fov_unit = FovUnit::kRadians});
  ASSERT_TRUE(radians);
  EXPECT_NEAR(radians->cameras[0].pinhole.intrinsics.fy_px, 50 / std::tan(0.435), 1e-9);
  ExpectPathError(ParsedNerfstudio(kNerfstudioText, {.fov_unit = FovUnit::kRadians}), "n.json",
                  {"\"fov\" is 90", "in radians"});
  // Our own keys agree with degrees only.
  const double fy_px = 50 / std::tan(RadiansFromDegrees(0.435));
  const std::string exact = With(
      text, "\"aspect\": 2", "\"lf_intrinsics\": [60, " + std::to_string(fy_px) + ", 100, 50, 0]");
  ASSERT_TRUE(ParsedNerfstudio(exact)) << ParsedNerfstudio(exact).error().message;
  EXPECT_FALSE(ParsedNerfstudio(exact)->largest_fov);
}

TEST(NerfstudioPath, WithoutFpsTheDurationTellsThem) {
  const Result<ForeignPath> path = ParsedNerfstudio(With(kNerfstudioText, "\"fps\": 10, ", ""));
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->fps, 10, 1e-12);
  const std::string text = With(kNerfstudioText, "\"fps\": 10, \"seconds\": 0.1", "\"x\": 0");
  const Result<ForeignPath> none = ParsedNerfstudio(text);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->fps, 30);
  EXPECT_EQ(none->lacks.size(), 1u);
  EXPECT_EQ(ParsedNerfstudio(text, {.fps = 12})->fps, 12);
}

TEST(NerfstudioPath, ErrorsNameTheFrameTheValueAndTheRemedy) {
  ExpectNerfstudioError("perspective", "equirectangular",
                        {"\"camera_type\" is \"equirectangular\"", "choose Perspective"});
  ExpectNerfstudioError("200", "200.5", {"\"render_width\" is 200.5", "65536"});
  ExpectNerfstudioError("\"render_height\": 100, ", "", {"\"render_height\" is missing"});
  ExpectNerfstudioError("200,\n\"render_height\": 100", "65536,\n\"render_height\": 65536",
                        {"65536 x 65536 are more than"});
  ExpectNerfstudioError("\"fps\": 10", "\"fps\": 0", {"\"fps\" is 0"});
  ExpectNerfstudioError("90", "180", {"camera_path[0]: \"fov\" is 180", "vertical"});
  ExpectNerfstudioError("\"fov\": 90, ", "", {"camera_path[0]: \"fov\" is missing"});
  ExpectNerfstudioError("[1, 0, 0, 1, 0,", "[1, 0, 0, 0,",
                        {"camera_path[0]: \"camera_to_world\"", "a list of 16 numbers"});
  ExpectNerfstudioError("[1, 0, 0, 1, 0, 0, -1, 2, 0, 1, 0, 3, 0, 0, 0, 1]",
                        "[1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 1, 2, 3, 1]",
                        {"last row 1, 2, 3, 1", "column-major"});
  ExpectNerfstudioError("[1, 0, 0, 1,", "[-1, 0, 0, 1,", {"camera_path[0]: \"camera_to_world\""});
  ExpectNerfstudioError("\"aspect\"", "\"lf_fucus_distance\"",
                        {"\"lf_fucus_distance\" is not a known key", "lf_focus_distance"});
  ExpectNerfstudioError("\"aspect\"", "\"lf_unit_m\"", {"move it to the top level"});
  ExpectNerfstudioError("\"seconds\"", "\"lf_blades\"", {"move it into each frame"});
}

TEST(NerfstudioPath, ListsThatAreNoFramesAreErrors) {
  const std::string head = R"({"render_width": 9, "render_height": 9, "fps": 9, "camera_path": )";
  const auto error = [&](const std::string& rest, const std::string& part) {
    ExpectPathError(ParsedNerfstudio(head + rest), "n.json", {part});
  };
  error("[]}", "holds no objects");
  error("7}", "\"camera_path\" is 7: expected a list of objects");
  error("[{}, 3]}", "2 entries, 1 of which are no objects");
  error("[{}], \"camera_path\": [{}, {}]}", "occurs twice");
  error("[{]}", "is not JSON");
  error("[{\"fov\": nul}]}", "is not JSON");
  error("[{}", "is not JSON");
}

TEST(NerfstudioPath, KeysOfOursGiveTheLensAndTheExactCamera) {
  const std::string text = With(
      kNerfstudioText, "\"aspect\": 2",
      R"("lf_aperture_diameter": 0.25, "lf_focus_distance": 7, "lf_blades": 5, "lf_focal_length": 2,
         "lf_sensor_width": 3, "lf_blade_rotation_rad": 0.5, "lf_focus_tilt_rad": [0.1, -0.2],
         "lf_intrinsics": [60, 50, 101, 49, 0.5],
         "lf_cam_from_world": [1, 0, 0, -1, 0, 0, -1, 3.0000000001, 0, 1, 0, -2])");
  const Result<ForeignPath> path = ParsedNerfstudio(text);
  ASSERT_TRUE(path) << path.error().message;
  const ForeignCamera& camera = path->cameras[0];
  EXPECT_EQ(camera.aperture_diameter_w, 0.25);
  EXPECT_EQ(camera.focus_distance_w, 7);
  EXPECT_EQ(camera.focal_length_w, 2);
  EXPECT_EQ(camera.sensor_width_w, 3);
  EXPECT_EQ(camera.blades, 5);
  EXPECT_EQ(camera.blade_rotation_rad, 0.5);
  EXPECT_EQ(camera.focus_tilt.vertical_rad, -0.2);
  EXPECT_EQ(camera.pinhole.intrinsics.fx_px, 60);
  EXPECT_EQ(camera.pinhole.intrinsics.skew_px, 0.5);
  EXPECT_EQ(camera.pinhole.cam_from_world.translation, Vec3(-1, 3.0000000001, -2));
}

TEST(NerfstudioPath, KeysOfOursMustAgreeWithTheOthers) {
  ExpectNerfstudioError("\"aspect\": 2",
                        "\"lf_cam_from_world\": [1, 0, 0, -1, 0, 0, -1, 3.1, 0, 1, 0, -2]",
                        {"\"lf_cam_from_world\" is another pose", "remove"});
  // Another program rolled the camera, and kept the translation.
  ExpectNerfstudioError("\"aspect\": 2",
                        "\"lf_cam_from_world\": [0, 0, -1, -1, -1, 0, 0, 3, 0, 1, 0, -2]",
                        {"\"lf_cam_from_world\" is another pose", "remove"});
  ExpectNerfstudioError("\"aspect\": 2", "\"lf_intrinsics\": [60, 51, 100, 50, 0]",
                        {"\"lf_intrinsics\" is a list of 5", "fy about 5"});
  ExpectNerfstudioError("\"aspect\": 2", "\"lf_blades\": 2", {"0 or a whole number from 3"});
  ExpectNerfstudioError("\"aspect\": 2", "\"lf_focus_distance\": 0", {"world units above 0"});
}

class NerfstudioFileTest : public FolderTest {
 protected:
  void Write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, text));
  }
  RenderCamera Camera(const PathOptions& options = {}) {
    const Result<CameraPath> path = OpenPath(folder_ / "camera_path.json", options);
    if (!path) ADD_FAILURE() << path.error().message;
    return path ? path->Camera({1}) : RenderCamera{};
  }
};

// nerfstudio moves x to 0.5 (R x + t), with R = a quarter turn about z and t = (10, 20, 30).
constexpr const char* kTrained =
    R"({"transform": [[0, -1, 0, 10], [1, 0, 0, 20], [0, 0, 1, 30]], "scale": 0.5})";

TEST_F(NerfstudioFileTest, TheTrainedSpaceIsUndoneByTheFileBesideThePath) {
  Write("camera_path.json", kNerfstudioText);
  EXPECT_EQ(Camera().pinhole.CentreWorld(), Vec3(1, 2, 3));
  Write("dataparser_transforms.json", kTrained);
  // The camera is at R x + t = (2, 4, 6), so that R x = (-8, -16, -24).
  const RenderCamera camera = Camera();
  EXPECT_LT((camera.pinhole.CentreWorld() - Vec3(-16, 8, -24)).norm(), 1e-12);
  EXPECT_LT((camera.pinhole.ForwardWorld() - Vec3(1, 0, 0)).norm(), 1e-12);
  // Another file, which is named, replaces it.
  Write("other.json", R"({"transform": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], "scale": 2})");
  EXPECT_LT((Camera({.dataparser_transforms = folder_ / "other.json"}).pinhole.CentreWorld() -
             Vec3(0.5, 1, 1.5))
                .norm(),
            1e-12);
  // A path that says that it is in the world is not moved.
  Write("camera_path.json", With(kNerfstudioText, "\"fps\"", "\"lf_space\": \"world\", \"fps\""));
  EXPECT_EQ(Camera().pinhole.CentreWorld(), Vec3(1, 2, 3));
  EXPECT_EQ(
      OpenPath(folder_ / "camera_path.json", {.dataparser_transforms = folder_ / "other.json"})
          .error()
          .kind,
      ErrorKind::kUsage);
}

TEST_F(NerfstudioFileTest, TheWorldOfATransformsJsonIsBehindItsAppliedTransform) {
  Write("camera_path.json", kNerfstudioText);
  Write("dataparser_transforms.json", kTrained);
  // The saved poses are those of the original world with x, y and z exchanged, twice as large.
  Write("transforms.json",
        R"({"applied_transform": [[0, 1, 0, 1], [0, 0, 1, 0], [1, 0, 0, 0]], "applied_scale": 0.25,
            "frames": [{"file_path": "a.png"}]})");
  // With the scale 0.5 / 0.25, R x + t = (0.5, 1, 1.5): x = (-19, 9.5, -28.5).
  const Vec3 expected(9.5 + 1, -28.5, -19);
  EXPECT_LT((Camera({.light_field = folder_}).pinhole.CentreWorld() - expected).norm(), 1e-12);
  EXPECT_LT((Camera({.light_field = folder_ / "transforms.json"}).pinhole.CentreWorld() - expected)
                .norm(),
            1e-12);
}

TEST_F(NerfstudioFileTest, WrongTransformsAreErrors) {
  Write("camera_path.json", kNerfstudioText);
  const std::filesystem::path file = folder_ / "dataparser_transforms.json";
  const auto expect = [&](const std::string& text, const std::string& part) {
    Write("dataparser_transforms.json", text);
    ExpectPathError(OpenPath(folder_ / "camera_path.json", {}), file.string(), {part});
  };
  expect("{}", "\"transform\" is missing");
  expect(With(kTrained, "0.5", "0"), "\"scale\" is 0");
  expect(With(kTrained, "[0, 0, 1, 30]", "[0, 0, -1, 30]"), "\"transform\"");
  expect("{", "is not JSON");
}

TEST_F(NerfstudioFileTest, MissingQuantitiesAreCompletedOrReplaced) {
  Write("camera_path.json", kNerfstudioText);
  RenderCamera camera = Camera();
  EXPECT_EQ(camera.aperture.radius_w, 0);
  EXPECT_EQ(camera.focus_distance_w, 1);
  EXPECT_NEAR(camera.sensor_width_w, 0.036, 1e-15);
  EXPECT_NEAR(camera.focal_length_w, 0.009, 1e-15);  // 45 degrees to each side of 18 mm
  camera = Camera({.depth_range = DepthRange{2, 6}});
  EXPECT_NEAR(camera.focus_distance_w, 3, 1e-15);
  EXPECT_NEAR(camera.focus_plane.offset_w, 5, 1e-12);  // y = 2 + 3
  camera = Camera({.light_field_unit_m = 2.0,
                   .resolution_px = std::array<int, 2>{400, 100},
                   .sensor_width_mm = 24,
                   .f_number = 2,
                   .focus_distance_w = 4});
  EXPECT_NEAR(camera.sensor_width_w, 0.012, 1e-15);
  EXPECT_NEAR(camera.focal_length_w, 0.003, 1e-15);
  EXPECT_NEAR(camera.aperture.radius_w, 0.00075, 1e-15);
  EXPECT_EQ(camera.focus_distance_w, 4);
  EXPECT_EQ(camera.pinhole.intrinsics.width_px, 400);
  EXPECT_NEAR(camera.pinhole.intrinsics.fx_px, 100, 1e-12);  // the horizontal view is kept
  EXPECT_EQ(camera.pinhole.intrinsics.cy_px, 50);
  EXPECT_EQ(OpenPath(folder_ / "camera_path.json", {.f_number = 2, .aperture_diameter_mm = 3})
                .error()
                .kind,
            ErrorKind::kUsage);
}

TEST_F(NerfstudioFileTest, RadiansAreAskedFor) {
  Write("camera_path.json", With(kNerfstudioText, "90", "0.87"));
  ExpectPathError(OpenPath(folder_ / "camera_path.json", {}),
                  (folder_ / "camera_path.json").string(),
                  {"exceeds 0.87", "in radians it is 49.85 degrees", "{lfpath fov_unit radians}"});
  const double focal_px = 50 / std::tan(0.435);
  EXPECT_NEAR(Camera({.fov_unit = FovUnit::kRadians}).pinhole.intrinsics.fy_px, focal_px, 1e-9);
  EXPECT_NEAR(Camera({.fov_unit = FovUnit::kDegrees}).pinhole.intrinsics.fy_px,
              50 / std::tan(RadiansFromDegrees(0.435)), 1e-6);
  // A zoom from 0.87 to 30 is in degrees.
  Write("camera_path.json",
        With(With(kNerfstudioText, "90", "0.87"), "\"aspect\": 2}",
             "\"aspect\": 2}, {\"camera_to_world\": [1, 0, 0, 1, 0, 0, -1, 2, 0, 1, 0, 3, 0, 0, 0, "
             "1], \"fov\": 30}"));
  EXPECT_NEAR(Camera().pinhole.intrinsics.fy_px, 50 / std::tan(RadiansFromDegrees(0.435)), 1e-6);
  Write("camera_path.json", "format: lfpath 1\n");
  EXPECT_EQ(OpenPath(folder_ / "camera_path.json", {.fov_unit = FovUnit::kDegrees}).error().kind,
            ErrorKind::kUsage);
}

TEST_F(NerfstudioFileTest, AnotherUnitThanTheLightFieldsIsAnError) {
  Write("camera_path.json", With(kNerfstudioText, "\"fps\"", "\"lf_unit_m\": 0.5, \"fps\""));
  EXPECT_EQ(Camera().unit_m, 0.5);
  EXPECT_NEAR(Camera().sensor_width_w, 0.072, 1e-15);
  ExpectPathError(OpenPath(folder_ / "camera_path.json", {.light_field_unit_m = 1.0}),
                  (folder_ / "camera_path.json").string(), {"\"lf_unit_m\" is 0.5"});
}

}  // namespace
}  // namespace lf
