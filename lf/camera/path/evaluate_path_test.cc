// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/evaluate_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/path/test_near.h"
#include "lf/camera/path/test_path.h"

namespace lf {
namespace {

using testing::AssertionResult;

TEST(Path, FrameOneIsTimeZero) {
  const auto path = TestPath{}.Parse();
  ASSERT_TRUE(path);
  EXPECT_EQ(path->frame_count(), 21u);
  EXPECT_EQ(path->Camera({1}).time_s, 0);
  EXPECT_DOUBLE_EQ(path->Camera({21}).time_s, 2);
}

TEST(Path, AShutterExposesEachFrameAtInstantsAroundItsTime) {
  TestPath moving;
  moving.clock += "shutter: {angle_deg: 180, samples: 4}\n";
  moving.pose = "position: [0, 0, -2], speed: [1, 0, 0], look_at: [0, 0, 0], follow: direction";
  moving.aperture = "aperture_diameter_mm: 40, aperture_diameter_speed_mm: -8";
  moving.focus = "focus_distance: 2, focus_distance_speed: 0.5";
  const auto path = moving.Parse();
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(path->instants.size(), 4 * 21u);
  EXPECT_EQ(path->AllInstants().size(), 4 * 21u);
  // The shutter is open for 0.05 s; the instants are the middles of four parts of this time.
  const double offsets_s[] = {-0.01875, -0.00625, 0.00625, 0.01875};
  for (const uint32_t frame : {1U, 2U, 21U}) {
    const std::span<const RenderCamera> instants = path->Instants({frame});
    ASSERT_EQ(instants.size(), 4u);
    for (size_t k = 0; k < 4; ++k) {
      const double time_s = (frame - 1) / 10.0 + offsets_s[k];
      EXPECT_NEAR(instants[k].time_s, time_s, 1e-12);
      EXPECT_NEAR(instants[k].pinhole.CentreWorld().x(), time_s, 1e-12);
      EXPECT_NEAR(instants[k].aperture.radius_w, 0.02 - 0.004 * time_s, 1e-12);
      EXPECT_NEAR(instants[k].focus_distance_w, 2 + 0.5 * time_s, 1e-12);
    }
  }
  moving.clock = TestPath{}.clock;
  const auto without = moving.Parse();
  ASSERT_TRUE(without);
  for (uint32_t frame = 1; frame <= 21; ++frame) {
    EXPECT_EQ(path->Camera({frame}).time_s, without->Camera({frame}).time_s);
    EXPECT_EQ(without->Instants({frame}).size(), 1u);
    EXPECT_EQ(without->Instants({frame}).data(), &without->Camera({frame}));
  }
}

TEST(Path, KeyframesHoldForInstantsBeforeTheFirstOne) {
  TestPath moving;
  moving.clock += "shutter: {angle_deg: 360, samples: 2}\n";
  moving.more = "keyframes: {focus_distance: [{time: 0, value: 2}, {time: 2, value: 4}]}\n";
  const auto path = moving.Parse();
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(path->Instants({1})[0].focus_distance_w, 2);
  EXPECT_GT(path->Instants({1})[1].focus_distance_w, 2);
  EXPECT_LT(path->Instants({21})[0].focus_distance_w, 4);
  EXPECT_EQ(path->Instants({21})[1].focus_distance_w, 4);
}

TEST(Path, AShutterOfOneSampleIsNone) {
  TestPath path;
  path.clock += "shutter: {angle_deg: 180, samples: 1}\n";
  EXPECT_FALSE(path.Parse()->shutter.exists());
  EXPECT_TRUE(path.Parse()->instants.empty());
}

TEST(Path, AnInstantOutOfRangeIsAnErrorOfItsFrame) {
  TestPath path;
  path.clock += "shutter: {angle_deg: 360, samples: 2}\n";
  path.aperture = "aperture_diameter_mm: 0, aperture_diameter_speed_mm: 1";
  EXPECT_NE(path.Error().find("at frame 1 (-0.025 s): -0.025 must be at least 0"),
            std::string::npos)
      << path.Error();
}

TEST(Path, ElementsAreSquaresAroundTheCentreOfThePlate) {
  const Intrinsics k = TestPath{}.At(1).pinhole.intrinsics;
  EXPECT_DOUBLE_EQ(k.fx_px, 200 * 50 / 36.0);
  EXPECT_EQ(k.fx_px, k.fy_px);
  EXPECT_EQ(k.cx_px, 100);
  EXPECT_EQ(k.cy_px, 50);
  EXPECT_EQ(k.width_px, 200);
  EXPECT_EQ(k.height_px, 100);
}

TEST(Path, TheCentreOfAnOddPlateIsTheMiddleOfAnElement) {
  TestPath path;
  path.clock = "fps: 10\nframes: 1\nresolution: [201, 99]\n";
  const Intrinsics k = path.At(1).pinhole.intrinsics;
  EXPECT_DOUBLE_EQ(k.fx_px, 201 * 50 / 36.0);
  EXPECT_EQ(k.cx_px, 100.5);
  EXPECT_EQ(k.cy_px, 49.5);
}

TEST(Path, AShiftMovesThePictureAndNotTheCamera) {
  TestPath shifted;
  shifted.optics += ", shift_mm: {horizontal: 9, vertical: -4.5}";
  const RenderCamera camera = shifted.At(1), straight = TestPath{}.At(1);
  // The plate is 36 mm and 200 elements wide: 9 mm are 50 elements.
  EXPECT_DOUBLE_EQ(camera.pinhole.intrinsics.cx_px, 50);
  EXPECT_DOUBLE_EQ(camera.pinhole.intrinsics.cy_px, 25);
  EXPECT_EQ(camera.pinhole.cam_from_world.rotation, straight.pinhole.cam_from_world.rotation);
  EXPECT_EQ(camera.focus_plane.offset_w, straight.focus_plane.offset_w);
  EXPECT_NEAR((ShiftOf(camera) - Vec2(0.009, -0.0045)).norm(), 0, 1e-15);
  EXPECT_EQ(ShiftOf(straight), Vec2::Zero());
  // A point on the right and below moves to the middle of the picture, which shows more of it.
  const auto right = Project(camera.pinhole, {2 * 0.009 / 0.05, 2 * 0.0045 / 0.05, 0});
  EXPECT_NEAR((*right - Vec2(100, 50)).norm(), 0, 1e-9);
}

TEST(Path, AShiftMayMove) {
  TestPath path;
  path.more =
      "keyframes: {shift_mm: [{time: 0, value: {horizontal: 0}}, {time: 2, value: "
      "{horizontal: 18}, interpolation: linear}]}\n";
  EXPECT_DOUBLE_EQ(path.At(11).pinhole.intrinsics.cx_px, 50);
}

TEST(Path, KeysMayEase) {
  TestPath path;
  path.more =
      "keyframes:\n"
      "  focus_distance: [{time: 0, value: 2}, {time: 2, value: 4, interpolation: ease}]\n"
      "  position: [{time: 0, value: [0, 0, -2]}, {time: 1, value: [1, 0, -2], interpolation: "
      "ease_in}, {time: 2, value: [2, 0, -2], interpolation: ease_out}]\n";
  // A quarter of the time has 0.103515625 of the way.
  EXPECT_NEAR(path.At(6).focus_distance_w, 2 + 2 * 0.103515625, 1e-12);
  EXPECT_NEAR(path.At(11).focus_distance_w, 3, 1e-12);
  ExpectNear(path.At(11).pinhole.CentreWorld(), {1, 0, -2});
  // Both halves have the same speed in their middle, 1 per second: x is 3 x^3 - 2 x^4 for m = 1.
  ExpectNear(path.At(6).pinhole.CentreWorld(), {3 * 0.125 - 2 * 0.0625, 0, -2});
  path.more =
      "keyframes: {focus_distance: [{time: 0, value: 2}, {time: 2, value: 4, interpolation: "
      "ease_inout}]}\n";
  EXPECT_NE(path.Error().find("smooth or linear or step or ease or ease_in or ease_out"),
            std::string::npos)
      << path.Error();
}

TEST(Path, TheOpeningHasAShape) {
  TestPath path;
  path.aperture += ", blades: 6, ratio: 1.8, blade_roundness: 0.25";
  const Aperture aperture = path.At(1).aperture;
  EXPECT_EQ(aperture.ratio, 1.8);
  EXPECT_EQ(aperture.roundness, 0.25);
  EXPECT_EQ(aperture.radius_w, 0.002);
  EXPECT_FALSE(HasShape(TestPath{}.At(1)));
  path.aperture = "aperture_diameter_mm: 4, ratio: 0";
  EXPECT_NE(path.Error().find("lens.ratio"), std::string::npos) << path.Error();
  EXPECT_NE(path.Error().find("from 0.1 to 10"), std::string::npos) << path.Error();
  path.aperture = "aperture_diameter_mm: 4, blade_roundness: 1.5";
  EXPECT_NE(path.Error().find("lens.blade_roundness"), std::string::npos) << path.Error();
}

TEST(Path, UpIsMinusYUnlessSaid) {
  ExpectNear(TestPath{}.At(1).pinhole.UpWorld(), {0, -1, 0});
  TestPath path;
  path.pose = "position: [0, -2, 0], look_at: [0, 0, 0], up: [0, 0, 3]";
  ExpectNear(path.At(1).pinhole.UpWorld(), {0, 0, 1});
}

TEST(Path, FollowingKeepsThePointInTheCentre) {
  TestPath path;
  path.pose = "position: [0, 0, -2], look_at: [0.1, 0.2, 0], speed: [1, 0, 0]";
  for (const uint32_t frame : {1u, 11u, 21u}) {
    const auto centre = Project(path.At(frame).pinhole, {0.1, 0.2, 0});
    EXPECT_NEAR((*centre - Vec2(100, 50)).norm(), 0, 1e-9);
  }
}

TEST(Path, KeepingTheDirectionMovesSideways) {
  TestPath path;
  path.pose = "position: [0, 0, -2], look_at: [0, 0, 0], speed: [1, 0, 0], follow: direction";
  ExpectNear(path.At(21).pinhole.ForwardWorld(), {0, 0, 1});
  ExpectNear(path.At(21).pinhole.CentreWorld(), {2, 0, -2});
}

TEST(Path, OrientationIsGivenByAnglesOrQuaternionAlike) {
  TestPath angles, quaternion;
  angles.pose = "position: [1, 2, 3], orientation: {yaw: 90}";
  quaternion.pose = "position: [1, 2, 3], quaternion: [0.70711, 0, 0.70711, 0]";
  ExpectNear(angles.At(1).pinhole.ForwardWorld(), {1, 0, 0});
  ExpectNear(quaternion.At(1).pinhole.ForwardWorld(), {1, 0, 0});
  ExpectNear(quaternion.At(1).pinhole.CentreWorld(), {1, 2, 3});
}

TEST(Path, AnglesHaveASpeed) {
  TestPath path;
  path.pose = "position: [0, 0, 0], orientation: {yaw: 10}, orientation_speed: {yaw: 40}";
  ExpectNear(path.At(21).pinhole.ForwardWorld(), {1, 0, 0});
}

TEST(Path, OrientationKeysAreJoinedByTheShorterArc) {
  TestPath path;
  path.pose = "position: [0, 0, 0]";
  path.more =
      "keyframes: {orientation: [{time: 0, value: {yaw: 350}}, {time: 2, value: {yaw: 10}}]}\n";
  ExpectNear(path.At(11).pinhole.ForwardWorld(), {0, 0, 1});
}

TEST(Path, RollTurnsTheCameraClockwise) {
  TestPath path;
  path.pose += ", roll_speed_deg: 45";
  ExpectNear(path.At(21).pinhole.UpWorld(), {1, 0, 0});
  ExpectNear(path.At(21).pinhole.ForwardWorld(), {0, 0, 1});
}

TEST(Path, MillimetresAreConvertedByTheUnit) {
  TestPath path;
  path.clock += "unit_m: 0.01\n";  // a world unit is a centimetre
  path.pose = "position_mm: [0, 0, -2000], look_at: [0, 0, 0], speed_mm: [10, 0, 0]";
  path.focus = "focus_distance_mm: 2000, focus_distance_speed_mm: 50";
  const RenderCamera camera = path.At(21);
  EXPECT_DOUBLE_EQ(2 * camera.aperture.radius_w, 0.4);
  EXPECT_DOUBLE_EQ(camera.focal_length_w, 5);
  EXPECT_DOUBLE_EQ(camera.sensor_width_w, 3.6);
  EXPECT_DOUBLE_EQ(camera.focus_distance_w, 210);
  EXPECT_DOUBLE_EQ(camera.unit_m, 0.01);
  ExpectNear(camera.pinhole.CentreWorld(), {2, 0, -200});
}

TEST(Path, TwoOfSensorFocalLengthAndFieldOfViewGiveTheThird) {
  const double view = 2 * std::atan(36.0 / 100);
  const std::string degrees = std::to_string(DegreesFromRadians(view));
  TestPath path;
  for (const std::string& optics :
       {std::string("focal_length_mm: 50"), "field_of_view_deg: " + degrees,
        "field_of_view_deg: " + degrees + ", focal_length_mm: 50",
        "field_of_view_deg: " + degrees + ", sensor_width_mm: 36"}) {
    path.optics = optics;
    EXPECT_NEAR(path.At(1).focal_length_w, 0.05, 1e-9) << optics;
    EXPECT_NEAR(path.At(1).sensor_width_w, 0.036, 1e-9) << optics;
  }
}

TEST(Path, FNumberIsFocalLengthOverDiameter) {
  TestPath path;
  path.aperture = "f_number: 2";
  EXPECT_DOUBLE_EQ(2 * path.At(1).aperture.radius_w, 0.025);
}

TEST(Path, ABreathingLensFollowsTheLensLaw) {
  TestPath path;
  path.focus = "focus_distance_mm: 100, breathing: true";
  // f = 50 and g = 100 give b = 100, twice the focal length.
  EXPECT_NEAR(path.At(1).pinhole.intrinsics.fx_px, 200 * 100 / 36.0, 1e-9);
  path.focus = "focus_distance_mm: 100, breathing: false";
  EXPECT_NEAR(path.At(1).pinhole.intrinsics.fx_px, 200 * 50 / 36.0, 1e-9);
}

TEST(Path, TheFocusPointIsSharpOnTiltedPlanesToo) {
  TestPath path;
  path.pose = "position: [0, 0, -2], look_at: [0.3, 0.1, 0], speed: [0.5, 0, 0]";
  path.focus = "focus_point: [0.2, -0.1, 0.3], focus_tilt_deg: {horizontal: 20, vertical: -35}";
  for (const uint32_t frame : {1u, 14u}) {
    const Plane plane = path.At(frame).focus_plane;
    EXPECT_NEAR(plane.normal.dot(Vec3(0.2, -0.1, 0.3)), plane.offset_w, 1e-12);
  }
}

TEST(Path, ClosingBladesTurnPerStop) {
  TestPath path;
  path.aperture =
      "blades: 5, blade_rotation_deg: 10, blade_rotation_per_stop_deg: 3, aperture_diameter_mm: 8";
  path.more = "keyframes: {aperture_diameter_mm: [{time: 1, value: 4}, {time: 2, value: 0}]}\n";
  EXPECT_EQ(path.At(1).aperture.blades, 5);
  EXPECT_NEAR(DegreesFromRadians(path.At(1).aperture.rotation_rad), 10, 1e-9);
  // Half the diameter is two stops smaller.
  EXPECT_NEAR(DegreesFromRadians(path.At(11).aperture.rotation_rad), 16, 1e-9);
  EXPECT_EQ(path.At(21).aperture.radius_w, 0);
  EXPECT_TRUE(std::isfinite(path.At(21).aperture.rotation_rad));
}

TEST(Path, EveryNumberMayMoveByItself) {
  TestPath path;
  path.more =
      "accelerations:\n"
      "  - {quantity: focal_length_mm, from: 0, to: 1, value: 20}\n"
      "  - {quantity: focus_tilt_deg, from: 0, to: 1, value: {vertical: 8}}\n"
      "  - {quantity: blade_rotation_deg, from: 0, to: 2, value: 5}\n"
      "keyframes:\n"
      "  focus_distance: [{time: 2, value: 4, interpolation: linear}]\n";
  const RenderCamera camera = path.At(21);
  EXPECT_NEAR(camera.focal_length_w, 0.050 + 0.010 + 0.020, 1e-12);
  EXPECT_NEAR(DegreesFromRadians(camera.focus_tilt.vertical_rad), 4 + 8, 1e-9);
  EXPECT_NEAR(DegreesFromRadians(camera.aperture.rotation_rad), 10, 1e-9);
  EXPECT_NEAR(camera.focus_distance_w, 4, 1e-12);
  EXPECT_NEAR(path.At(11).focus_distance_w, 3, 1e-12);  // the start value is the key at time 0
}

TEST(Path, AStartValueHoldsUntilAKeyThatFollowsAtOnce) {
  TestPath path;
  path.more = "keyframes: {focus_distance: [{time: 0.0000015, value: 4, interpolation: linear}]}\n";
  EXPECT_EQ(path.At(1).focus_distance_w, 2);
  EXPECT_EQ(path.At(2).focus_distance_w, 4);
}

TEST(Path, NamesTheFrameAtWhichAQuantityLeavesItsRange) {
  TestPath path;
  path.focus = "focus_distance: 2, focus_distance_speed: -1.5";
  EXPECT_TRUE(
      path.Error().ends_with("lens.focus_distance at frame 15 (1.4 s): -0.1 must be above 0 (below "
                             "1e+09); change its start value, keyframes or accelerations"))
      << path.Error();
  path = {};
  path.aperture = "aperture_diameter_mm: 4, aperture_diameter_speed_mm: -3";
  EXPECT_NE(path.Error().find("lens.aperture_diameter_mm at frame 15 (1.4 s): -0.2 must be at "
                              "least 0"),
            std::string::npos);
  path = {};
  path.focus += ", focus_tilt_speed_deg: {horizontal: 60}";
  EXPECT_NE(path.Error().find(
                "lens.focus_tilt_deg at frame 16 (1.5 s): 90 must be above -90 and below 90"),
            std::string::npos)
      << path.Error();
}

TEST(Path, ACameraMustLookSomewhereElseThanItStandsAndNotAlongUp) {
  TestPath path;
  path.pose = "position: [0, 0, -2], look_at: [0, 0, 0], speed: [0, 0, 1]";
  EXPECT_NE(path.Error().find("frame 21 (2 s): the camera is at the point that it looks at"),
            std::string::npos);
  path.pose = "position: [0, -1, 0], look_at: [0, 0, 0]";
  EXPECT_NE(path.Error().find("frame 1 (0 s): the camera looks along 'up'"), std::string::npos);
}

TEST(Path, TheFocusPointLiesInFrontOfTheLens) {
  TestPath path;
  path.focus = "focus_point: [0, 0, -3]";
  EXPECT_NE(path.Error().find("lens.focus_point at frame 1 (0 s)"), std::string::npos);
}

TEST(Path, ABreathingLensFocusesBeyondItsFocalLength) {
  TestPath path;
  path.focus = "focus_distance_mm: 100, focus_distance_speed_mm: -50, breathing: true";
  EXPECT_NE(
      path.Error().find("frame 11 (1 s): the focus distance is 0.05, expected more than the focal "
                        "length"),
      std::string::npos)
      << path.Error();
}

TEST(Path, AnAbsurdFieldOfViewIsAMistakeOfUnits) {
  TestPath path;
  path.optics = "sensor_width_mm: 36, focal_length: 500000";
  EXPECT_NE(path.Error().find("check their units"), std::string::npos);
}

}  // namespace
}  // namespace lf
