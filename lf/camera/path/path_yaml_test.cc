// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/path_yaml.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "lf/camera/path/test_path.h"

namespace lf {
namespace {

// Returns success if the error is at the last occurrence of `token` in the text and its message
// begins with `message`.
testing::AssertionResult Says(const TestPath& path, const std::string& token,
                              const std::string& message) {
  const std::string before = path.Text().substr(0, path.Text().rfind(token));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const size_t column = before.size() - before.rfind('\n');
  const std::string expected = fmt::format("{}:{}: {}", line, column, message);
  const std::string error = path.Error();
  if (error.starts_with(expected)) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "'" << error << "' does not begin with '" << expected << "'";
}

TEST(PathYaml, ThePathTheTestsStartFromIsValid) { EXPECT_EQ(TestPath{}.Error(), ""); }

TEST(PathYaml, UnknownKeysAreNamedWithTheNearestAndTheAllowedOnes) {
  TestPath path;
  path.clock += "fsp: 30\n";
  EXPECT_TRUE(Says(path, "fsp", "unknown key 'fsp'; did you mean 'fps'? known are: format, fps, "));
  path = {};
  path.optics = "focal_lenght_mm: 50";
  EXPECT_TRUE(Says(path, "focal_lenght",
                   "unknown key 'focal_lenght_mm' in camera; did you mean "
                   "'focal_length_mm'? known are: position, "));
  path = {};
  path.more = "keyframes: {apertur: [{time: 0, value: 1}]}\n";
  EXPECT_TRUE(Says(path, "apertur", "unknown key 'apertur' in keyframes"));
  path.more = "accelerations: [{quantity: focus, from: 0, to: 1, value: 1}]\n";
  EXPECT_TRUE(Says(path, "focus,", "unknown quantity 'focus' in accelerations"));
  path.more = "accelerations: [{quantity: quaternion, from: 0, to: 1, value: [1, 0, 0, 0]}]\n";
  EXPECT_TRUE(Says(path, "quaternion", "unknown quantity 'quaternion' in accelerations"));
  path.more = "keyframes: {roll_deg: [{time: 0, value: 1, interp: step}]}\n";
  EXPECT_TRUE(Says(path, "interp", "unknown key 'interp' in keyframes.roll_deg"));
}

TEST(PathYaml, AKeyStandsOnce) {
  TestPath path;
  path.clock += "fps: 25\n";
  EXPECT_TRUE(Says(path, "fps", "key 'fps' is given twice, first in line 2; remove one"));
  path = {};
  path.focus = "focus_distance: 2, focus_distance_mm: 2000";
  EXPECT_TRUE(Says(path, "focus_distance_mm",
                   "lens.focus_distance and lens.focus_distance_mm state the same quantity"));
}

TEST(PathYaml, MissingKeysAreNamedWithWhatToWrite) {
  const std::string text = TestPath{}.Text();
  for (const std::string key : {"fps", "frames", "resolution", "camera", "lens", "format"}) {
    std::string without = text;
    without.replace(without.find(key + ":"), key.size(), "#");
    const auto path = ParsePathYaml(without, "p.yaml", std::nullopt);
    ASSERT_FALSE(path) << key;
    EXPECT_NE(path.error().message.find(key + " is missing; write for instance '" + key),
              std::string::npos)
        << path.error().message;
  }
  TestPath path;
  path.pose = "look_at: [0, 0, 0]";
  EXPECT_TRUE(Says(path, "{look_at", "camera.position is missing; write"));
  path.pose = "position: [0, 0, 0]";
  EXPECT_TRUE(
      Says(path, "{position", "camera.look_at (or orientation, quaternion) is missing; write"));
  path = {};
  path.optics = "sensor_width_mm: 36";
  EXPECT_TRUE(
      Says(path, "{position", "camera.focal_length_mm (or field_of_view_deg) is missing; write"));
  path = {};
  path.aperture = "blades: 0";
  EXPECT_TRUE(Says(path, "{blades", "lens.aperture_diameter_mm (or f_number) is missing; write"));
  path = {};
  path.focus = "blades: 0";
  EXPECT_TRUE(Says(path, "{aperture", "lens.focus_distance (or focus_point) is missing; write"));
}

TEST(PathYaml, NumbersAreFiniteAndWithinTheirRange) {
  TestPath path;
  for (const std::string value : {".nan", ".inf", "nan", "inf", "1e400", "-1", "0", "2e9", "near",
                                  "'2'", "[2]", "", "0x10", "+-2", "2 m"}) {
    path.focus = "focus_distance: " + value;
    EXPECT_NE(path.Error().find(": lens.focus_distance: expected a number"), std::string::npos)
        << path.Error();
  }
  for (const std::string value : {"2", "+2", "2.", "2e0", ".2e1"}) {
    path.focus = "focus_distance: " + value;
    EXPECT_EQ(path.At(1).focus_distance_w, 2) << value;
  }
}

TEST(PathYaml, CountsAreWholeAndBounded) {
  TestPath path;
  const std::string tail = "\nresolution: [200, 100]\n";
  for (const std::string frames : {"0", "-1", "1.5", "1000001", "1e3", "many", "99999999999"}) {
    path.clock = "fps: 30\nframes: " + frames + tail;
    EXPECT_TRUE(
        Says(path, frames + tail, "frames: expected a whole number from 1 to 1000000, found"));
  }
  for (const std::string fps : {"0", "-1", "1e9", ".inf"}) {
    path.clock = "frames: 3\nfps: " + fps + tail;
    EXPECT_TRUE(Says(path, fps + tail, "fps: expected a number"));
  }
  for (const std::string fps : {"24000/0", "1/2/3", "24000/", "/1001", "9e9/1", "1/1001000"}) {
    path.clock = "frames: 3\nfps: " + fps + tail;
    EXPECT_TRUE(Says(path, fps + tail, "fps: expected a rate from 0.001 to 1e+06")) << fps;
  }
  path.clock = "frames: 3\nfps: 24000/1001" + tail;
  ASSERT_EQ(path.Error(), "");
  EXPECT_EQ(path.Parse()->fps, 24000.0 / 1001);
  for (const std::string size : {"[0, 1]", "[1]", "[70000, 1]", "[65536, 65536]", "12", "[1, x]"}) {
    path.clock = "fps: 30\nframes: 3\nresolution: " + size + "\n";
    EXPECT_TRUE(path.Error().starts_with("4:1")) << path.Error();
    EXPECT_NE(path.Error().find(": resolution"), std::string::npos) << path.Error();
  }
  path.clock = "fps: 30\nframes: 3\nresolution: [1]\n";
  EXPECT_NE(path.Error().find("expected [width, height] in sensor plate elements, found a list of "
                              "1"),
            std::string::npos)
      << path.Error();
  path = {};
  for (const std::string blades : {"1", "2", "-3", "65", "3.5"}) {
    path.aperture = "f_number: 2, blades: " + blades;
    EXPECT_TRUE(Says(path, blades + ", focus", "lens.blades: ")) << blades;
  }
}

TEST(PathYaml, QuantitiesStayInTheirRange) {
  TestPath path;
  path.aperture = "aperture_diameter_mm: -1";
  EXPECT_TRUE(
      Says(path, "-1",
           "lens.aperture_diameter_mm: expected a number at least 0 (at most 1e+09), found"));
  path.aperture = "f_number: 0";
  EXPECT_TRUE(Says(path, "0, focus", "lens.f_number: expected a number above 0"));
  path = {};
  path.optics = "field_of_view_deg: 180";
  EXPECT_TRUE(
      Says(path, "180", "camera.field_of_view_deg: expected a number above 0 and below 180"));
  path = {};
  path.focus += ", focus_tilt_deg: {vertical: 90}";
  EXPECT_TRUE(Says(path, "90", "lens.focus_tilt_deg.vertical: expected a number above -90 and"));
  path = {};
  path.pose = "position: [0, 0, 0], look_at: [0, 0, 1], up: [0, 0, 0]";
  EXPECT_TRUE(Says(path, "[0, 0, 0], sensor", "camera.up: [0, 0, 0] is no direction"));
  path.pose = "position: [0, 0, 0], quaternion: [2, 0, 0, 0]";
  EXPECT_TRUE(Says(path, "[2", "camera.quaternion: expected a rotation [w, x, y, z] of length 1"));
  path = {};
  path.more = "keyframes: {aperture_diameter: [{time: 0.01, value: -1}]}\n";
  EXPECT_TRUE(Says(path, "-1", "keyframes.aperture_diameter.value: expected a number at least 0"));
}

TEST(PathYaml, ContradictionsAreErrors) {
  TestPath path;
  path.aperture = "aperture_diameter: 1, f_number: 2";
  EXPECT_TRUE(
      Says(path, "f_number", "lens.aperture_diameter and lens.f_number contradict each other"));
  path = {};
  path.focus = "focus_distance: 1, focus_point: [0, 0, 0]";
  EXPECT_TRUE(
      Says(path, "focus_point", "lens.focus_distance and lens.focus_point contradict each other"));
  path = {};
  path.pose += ", orientation: {yaw: 0}";
  EXPECT_TRUE(
      Says(path, "orientation", "camera.look_at and camera.orientation contradict each other"));
  path.pose = "position: [0, 0, 0], orientation: {yaw: 0}, up: [0, -1, 0]";
  EXPECT_TRUE(Says(path, "up", "camera.up is only for look_at"));
  path = {};
  path.optics += ", field_of_view_deg: 40";
  EXPECT_TRUE(Says(path, "field_of", "sensor width, focal length and field of view"));
  path = {};
  path.pose += ", look_at_speed: [1, 0, 0], follow: direction";
  EXPECT_TRUE(
      Says(path, "follow", "camera.follow: 'direction' keeps the direction of time 0, but "));
}

TEST(PathYaml, AQuantityMovesInOneWay) {
  TestPath path;
  path.focus += ", focus_distance_speed: 1";
  path.more = "keyframes: {focus_distance_mm: [{time: 1, value: 3}]}\n";
  EXPECT_TRUE(
      Says(path, "focus_distance_speed", "lens.focus_distance has keyframes; remove them, or"));
  path = {};
  path.focus = "focus_point: [0, 0, 0], focus_distance_speed: 1";
  EXPECT_TRUE(Says(path, "focus_distance_speed",
                   "lens.focus_distance moves, but its value at time 0 is missing"));
}

TEST(PathYaml, KeysFollowEachOtherInTime) {
  TestPath path;
  path.more = "keyframes: {roll_deg: [{time: 1, value: 0}, {time: 1, value: 5}]}\n";
  EXPECT_TRUE(Says(path, "{time: 1, value: 5",
                   "keyframes.roll_deg: the key at 1 s must be at least a microsecond "
                   "later than the previous"));
  path.more = "keyframes: {roll_deg: [{time: -1, value: 0}]}\n";
  EXPECT_TRUE(Says(path, "-1", "keyframes.roll_deg.time: expected a number at least 0"));
  path.more = "keyframes: {roll_deg: []}\n";
  EXPECT_TRUE(Says(path, "[]", "keyframes.roll_deg: expected a list of keys"));
  path.more = "accelerations: [{quantity: roll_deg, from: 2, to: 2, value: 1}]\n";
  EXPECT_TRUE(Says(path, "2, value", "accelerations.to: 2 s is not after 'from', 2 s"));
}

TEST(PathYaml, TheStartIsTheKeyAtTimeZeroUnlessThereIsOne) {
  TestPath path;
  path.more = "keyframes: {focus_distance_mm: [{time: 1, value: 3000}]}\n";
  EXPECT_EQ(path.At(1).focus_distance_w, 2);
  EXPECT_EQ(path.At(11).focus_distance_w, 3);
  path.more = "keyframes: {focus_distance: [{time: 0, value: 5}]}\n";
  EXPECT_EQ(path.At(1).focus_distance_w, 5);
}

TEST(PathYaml, HalfATurnHasNoShorterArc) {
  TestPath path;
  path.pose = "position: [0, 0, 0]";
  path.more =
      "keyframes: {orientation: [{time: 0, value: {yaw: 0}}, {time: 1, value: {yaw: 180}}]}\n";
  EXPECT_TRUE(Says(path, "orientation",
                   "keyframes.orientation: the rotation to the key at 1 s is half a turn"));
}

TEST(PathYaml, TheUnitAgreesWithTheLightField) {
  TestPath path;
  EXPECT_EQ(path.Parse(0.5)->unit_m, 0.5);
  EXPECT_EQ(path.Parse()->unit_m, 1);
  path.clock += "unit_m: 0.5\n";
  EXPECT_EQ(path.Parse(0.5)->unit_m, 0.5);
  EXPECT_EQ(path.Parse()->unit_m, 0.5);
  const auto other = path.Parse(1);
  ASSERT_FALSE(other);
  EXPECT_TRUE(
      other.error().message.starts_with("p.yaml:5:9: unit_m: 0.5, but a world unit of the "
                                        "light field is 1 m"));
}

TEST(PathYaml, TheFormatComesFirst) {
  const auto path = ParsePathYaml("format: lfpath 2\nfuture: 1\n", "p.yaml", std::nullopt);
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().message, "p.yaml:1:9: format: expected lfpath 1, found 'lfpath 2'");
}

TEST(PathYaml, OneLineTellsOfAllErrors) {
  TestPath path;
  path.clock = "fps: 0\nframes: 0\nresolution: [200, 100]\n";
  path.focus = "focus_distance: -2";
  EXPECT_TRUE(path.Error().ends_with("(also wrong: lines 3, 6)")) << path.Error();
  EXPECT_EQ(path.Error().find('\n'), std::string::npos);
}

TEST(PathYaml, TextThatIsNoMapIsNoPath) {
  for (const std::string text : {"- 1\n", "42", "~", "''"}) {
    const auto path = ParsePathYaml(text, "p.yaml", std::nullopt);
    ASSERT_FALSE(path);
    EXPECT_NE(path.error().message.find("a camera path: expected a map"), std::string::npos);
  }
}

TEST(PathYaml, AFileThatIsNotThereIsNamed) {
  const auto path = ReadPathYaml("/nowhere/path.yaml", std::nullopt);
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().kind, ErrorKind::kInput);
  EXPECT_NE(path.error().message.find("/nowhere/path.yaml"), std::string::npos);
}

TEST(PathYaml, ChecksTheShutter) {
  const auto error = [](const std::string& shutter, const std::string& frames = "21") {
    TestPath path;
    path.clock =
        "fps: 10\nframes: " + frames + "\nresolution: [200, 100]\nshutter: " + shutter + "\n";
    return path.Error();
  };
  EXPECT_EQ(error("{angle_deg: 360, samples: 64}"), "");
  EXPECT_EQ(error("{angle_deg: 0, samples: 2}"), "");
  for (const auto& [shutter, words] :
       {std::pair("{angle_deg: 361, samples: 8}",
                  "shutter.angle_deg: expected a number from 0 to 360, found '361'"),
        std::pair("{angle_deg: -1, samples: 8}",
                  "shutter.angle_deg: expected a number from 0 to 360, found '-1'"),
        std::pair("{angle_deg: 180, samples: 65}",
                  "shutter.samples: expected a whole number from 1 to 64, found '65'"),
        std::pair("{angle_deg: 180, samples: 0}",
                  "shutter.samples: expected a whole number from 1 to 64, found '0'"),
        std::pair("{angle_deg: 180, samples: 2.5}", "shutter.samples"),
        std::pair("{angle_deg: 180}",
                  "shutter.samples is missing; write for instance 'samples: 8'"),
        std::pair("{samples: 8}", "shutter.angle_deg is missing"),
        std::pair("{angle: 180, samples: 8}",
                  "unknown key 'angle' in shutter; did you mean 'angle_deg'? known are: angle_deg"),
        std::pair("180", "shutter")})
    EXPECT_NE(error(shutter).find(words), std::string::npos) << error(shutter);
  EXPECT_NE(
      error("{angle_deg: 180, samples: 64}", "20000").find("1280000 cameras, more than 1000000"),
      std::string::npos)
      << error("{angle_deg: 180, samples: 64}", "20000");
}

TEST(PathYaml, StatesTheNumberOfTheFirstFrame) {
  TestPath path;
  const std::string tail = "\nresolution: [200, 100]\n";
  EXPECT_EQ(path.Parse()->first_frame, 1u);
  path.clock = "fps: 10\nframes: 21\nfirst_frame: 1001" + tail;
  path.pose = "position: [0, 0, -2], look_at: [0, 0, 0], speed: [1, 0, 0]";
  EXPECT_EQ(path.Parse()->frames(), (FrameNumbers{1001, 21}));
  // Times and cameras do not depend on it.
  EXPECT_EQ(path.At(1001).time_s, 0);
  EXPECT_DOUBLE_EQ(path.At(1021).pinhole.CentreWorld().x(), 2);
  for (const std::string first : {"-1", "1.5", "99999980", "x"}) {
    path.clock = "fps: 10\nframes: 21\nfirst_frame: " + first + tail;
    EXPECT_TRUE(
        Says(path, first + tail, "first_frame: expected a whole number from 0 to 99999979, found"));
  }
  path.clock = "fps: 10\nframes: 21\nfirst_frame: 99999979" + tail;
  EXPECT_EQ(path.Parse()->frames().last(), kLargestFrameNumber);
  path.clock = "fps: 10\nframes: 21\nfirst_frame: 1001" + tail;
  path.more = "keyframes: {aperture_diameter: [{time: 0, value: 1}, {time: 1, value: 2}]}\n";
  path.optics = "sensor_width_mm: 36, focal_length_mm: 50";
  path.pose = "position: [0, 0, -1], look_at: [0, 0, 0], speed: [0, 0, 1]";
  EXPECT_NE(path.Error().find("at frame 1011 (1 s)"), std::string::npos) << path.Error();
}

TEST(PathYaml, StatesTheViewsOfEachMoment) {
  TestPath path;
  EXPECT_EQ(path.Parse()->views, 1);
  path.clock = "fps: 10\nframes: 21\nviews: 7\nresolution: [200, 100]\n";
  EXPECT_EQ(path.Parse()->views, 7);
  EXPECT_EQ(path.Parse()->moment_count(), 3u);
  path.clock = "fps: 10\nframes: 21\nviews: 2\nresolution: [200, 100]\n";
  EXPECT_EQ(path.Error(),
            "4:8: views: 2 do not divide the 21 frames of the path: expected the same number of "
            "views of every moment");
  path.clock =
      "fps: 10\nframes: 4\nviews: 2\nresolution: [200, 100]\nshutter: {angle_deg: 90, samples: "
      "2}\n";
  EXPECT_NE(path.Error().find("remove the shutter"), std::string::npos) << path.Error();
}

}  // namespace
}  // namespace lf
