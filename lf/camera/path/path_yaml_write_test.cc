// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/path_yaml_write.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/path/test_path.h"

namespace lf {
namespace {

// Writes a path, reads it again, and expects the same cameras.
PathYaml ExpectRoundTrip(const CameraPath& path) {
  const Result<PathYaml> yaml = PathYamlOf(path);
  if (!yaml) {
    ADD_FAILURE() << yaml.error().message;
    return {};
  }
  const Result<CameraPath> read = ParsePathYaml(yaml->text, "p.yaml", std::nullopt);
  EXPECT_TRUE(read) << yaml->text;
  if (!read) return *yaml;
  EXPECT_EQ(read->fps, path.fps);
  EXPECT_EQ(read->unit_m, path.unit_m);
  EXPECT_EQ(read->frame_count(), path.frame_count());
  constexpr double kRounding = 1e-12;
  for (size_t i = 0; i < std::min(read->frame_count(), path.frame_count()); ++i) {
    const RenderCamera &a = path.cameras[i], &b = read->cameras[i];
    EXPECT_LT((a.pinhole.cam_from_world.rotation - b.pinhole.cam_from_world.rotation).norm(),
              kRounding);
    EXPECT_LT((a.pinhole.cam_from_world.translation - b.pinhole.cam_from_world.translation).norm(),
              kRounding);
    const double fx_px = a.pinhole.intrinsics.fx_px;
    EXPECT_NEAR(fx_px, b.pinhole.intrinsics.fx_px, kRounding * fx_px);
    EXPECT_EQ(a.pinhole.intrinsics.height_px, b.pinhole.intrinsics.height_px);
    EXPECT_NEAR(a.aperture.radius_w, b.aperture.radius_w, kRounding);
    EXPECT_EQ(a.aperture.blades, b.aperture.blades);
    EXPECT_EQ(a.aperture.ratio, b.aperture.ratio);
    EXPECT_EQ(a.aperture.roundness, b.aperture.roundness);
    EXPECT_NEAR(a.hood.distance_w, b.hood.distance_w, kRounding);
    EXPECT_NEAR(a.hood.radius_w, b.hood.radius_w, kRounding);
    EXPECT_NEAR(a.pinhole.intrinsics.cx_px, b.pinhole.intrinsics.cx_px, kRounding * fx_px);
    EXPECT_NEAR(a.pinhole.intrinsics.cy_px, b.pinhole.intrinsics.cy_px, kRounding * fx_px);
    EXPECT_NEAR(a.aperture.rotation_rad, b.aperture.rotation_rad, kRounding);
    EXPECT_LT((a.focus_plane.normal - b.focus_plane.normal).norm(), kRounding);
    EXPECT_NEAR(a.focus_plane.offset_w, b.focus_plane.offset_w, kRounding);
    EXPECT_NEAR(a.focal_length_w, b.focal_length_w, kRounding);
    EXPECT_EQ(a.time_s, b.time_s);
  }
  return *yaml;
}

CameraPath Parsed(const TestPath& text) {
  const Result<CameraPath> path = text.Parse();
  EXPECT_TRUE(path) << path.error().message;
  return path ? *path : CameraPath{};
}

TEST(PathYamlWrite, ACameraThatRestsIsStatedOnce) {
  const PathYaml yaml = ExpectRoundTrip(Parsed({}));
  EXPECT_EQ(yaml.text.find("keyframes"), std::string::npos) << yaml.text;
  EXPECT_TRUE(yaml.lost.empty());
}

TEST(PathYamlWrite, TheNumberOfTheFirstFrameIsKept) {
  CameraPath path = *TestPath{}.Parse();
  EXPECT_EQ(PathYamlOf(path)->text.find("first_frame"), std::string::npos);
  path.first_frame = 1001;
  const Result<CameraPath> read = ParsePathYaml(PathYamlOf(path)->text, "p.yaml", std::nullopt);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->first_frame, 1001u);
}

TEST(PathYamlWrite, EverythingThatMovesIsRestored) {
  const PathYaml yaml = ExpectRoundTrip(Parsed(
      {.clock = "fps: 7\nframes: 9\nresolution: [200, 100]\nunit_m: 0.25\n",
       .pose = "position: [0, 0, -2], speed: [0.3, 0.1, 0], look_at: [0, 0, 0], roll_deg: 7",
       .optics = "sensor_width_mm: 36, focal_length_mm: 50, focal_length_speed_mm: 3, "
                 "shift_mm: {horizontal: 2, vertical: -3}",
       .aperture = "aperture_diameter_mm: 4, aperture_diameter_speed_mm: -1, blades: 5, ratio: 2, "
                   "blade_roundness: 0.3, hood_distance_mm: 30, hood_diameter_mm: 40, "
                   "blade_rotation_deg: 10, blade_rotation_per_stop_deg: 4",
       .focus = "focus_distance: 2, focus_distance_speed: 0.5, focus_tilt_deg: {vertical: 10}, "
                "focus_tilt_speed_deg: {horizontal: 3}"}));
  EXPECT_NE(yaml.text.find("keyframes"), std::string::npos);
  EXPECT_TRUE(yaml.lost.empty());
}

TEST(PathYamlWrite, TheViewOfABreathingLensIsKept) {
  ExpectRoundTrip(Parsed({.optics = "sensor_width_mm: 36, focal_length_mm: 50, shift_mm: "
                                    "{vertical: 3}",
                          .focus = "focus_distance: 0.5, focus_distance_speed: 0.5, "
                                   "breathing: true"}));
}

TEST(PathYamlWrite, ASectionMayBeEmptyBecauseAllMoves) {
  const PathYaml yaml = ExpectRoundTrip(
      Parsed({.pose = "position: [0, 0, -2], speed: [0.3, 0.1, 0], look_at: [0, 0, 0]",
              .optics = "sensor_width_mm: 36, focal_length_mm: 50, focal_length_speed_mm: 3",
              .focus = "focus_distance: 0.5, focus_distance_speed: 0.5, breathing: true"}));
  EXPECT_NE(yaml.text.find("camera: {}"), std::string::npos) << yaml.text;
}

TEST(PathYamlWrite, HalfATurnBetweenFramesIsAJump) {
  CameraPath path = Parsed({.clock = "fps: 7\nframes: 2\nresolution: [200, 100]\n"});
  RenderCamera& second = path.cameras[1];
  second.pinhole.cam_from_world.rotation =
      Eigen::AngleAxisd(kPi, Vec3::UnitY()) * second.pinhole.cam_from_world.rotation;
  second.focus_plane = FocusPlane(second.pinhole, second.focus_distance_w, {});
  EXPECT_NE(ExpectRoundTrip(path).text.find("interpolation: step"), std::string::npos);
}

TEST(PathYamlWrite, TellsWhatTheFileCannotHold) {
  CameraPath path = Parsed({});
  path.cameras[4].pinhole.intrinsics.fy_px *= 1.1;
  path.cameras[5].aperture.blades = 6;
  const Result<PathYaml> yaml = PathYamlOf(path);
  ASSERT_TRUE(yaml);
  ASSERT_EQ(yaml->lost.size(), 2u);
  EXPECT_NE(yaml->lost[0].find("of 1 frame"), std::string::npos) << yaml->lost[0];
}

TEST(PathYamlWrite, ARoundingErrorOfTheShapeIsNoLoss) {
  CameraPath path = Parsed({.aperture = "aperture_diameter_mm: 4, ratio: 1.3, hood_distance: 0.1, "
                                        "hood_diameter: 0.07"});
  path.cameras[3].aperture.ratio = std::nextafter(1.3, 2);
  path.cameras[4].hood.radius_w = std::nextafter(path.cameras[4].hood.radius_w, 1);
  const Result<PathYaml> yaml = PathYamlOf(path);
  ASSERT_TRUE(yaml);
  EXPECT_TRUE(yaml->lost.empty()) << yaml->lost[0];
  path.cameras[3].aperture.ratio = 1.300001;
  EXPECT_EQ(PathYamlOf(path)->lost.size(), 1u);
}

TEST(PathYamlWrite, TooLongFilmsAreRefused) {
  CameraPath path = Parsed({});
  const RenderCamera first = path.cameras[0];
  path.cameras.assign(120'000, first);
  for (size_t i = 0; i < path.cameras.size(); ++i) {
    path.cameras[i].time_s = static_cast<double>(i) / path.fps;
    path.cameras[i].pinhole.cam_from_world.translation.x() = static_cast<double>(i);
  }
  const Result<PathYaml> yaml = PathYamlOf(path);
  ASSERT_FALSE(yaml);
  EXPECT_EQ(yaml.error().kind, ErrorKind::kOutput);
  EXPECT_NE(yaml.error().message.find("JSON"), std::string::npos);
}

TEST(PathYaml, KeepsTheShutter) {
  TestPath moving;
  moving.clock += "shutter: {angle_deg: 172.8, samples: 8}\n";
  moving.pose = "position: [0, 0, -2], speed: [1, 0, 0], look_at: [0, 0, 0], follow: direction";
  const auto path = moving.Parse();
  ASSERT_TRUE(path);
  const auto yaml = PathYamlOf(*path);
  ASSERT_TRUE(yaml);
  EXPECT_TRUE(yaml->lost.empty());
  const auto read = ParsePathYaml(yaml->text, "p.yaml", std::nullopt);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->shutter.angle_deg, 172.8);
  EXPECT_EQ(read->shutter.samples, 8);
  // Between the keyframes of a straight path, cameras move evenly. Before the first one, they rest.
  for (size_t i = 8; i + 8 < path->instants.size(); ++i)
    EXPECT_NEAR(read->instants[i].pinhole.CentreWorld().x(),
                path->instants[i].pinhole.CentreWorld().x(), 1e-9);
}

}  // namespace
}  // namespace lf
