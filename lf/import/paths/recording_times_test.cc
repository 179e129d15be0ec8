// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/recording_times.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/camera/path/path_yaml.h"
#include "lf/camera/path/path_yaml_write.h"
#include "lf/import/paths/resample_path.h"

namespace lf {
namespace {

CameraPath PathWith(const std::string& lines) {
  const Result<CameraPath> path = ParsePathYaml(
      "format: lfpath 1\nfps: 4\nresolution: [8, 6]\n" + lines +
          "\ncamera: {position: [0, 0, 0], look_at: [0, 0, 1], field_of_view_deg: 40}\n"
          "lens: {aperture_diameter: 0.1, focus_distance: 1}\n",
      "path.yaml", std::nullopt);
  EXPECT_TRUE(path) << path.error().message;
  return *path;
}

LightField FieldOf(const std::vector<double>& slices, bool is_of_path) {
  LightField field;
  field.source = "scene";
  field.slice_times = slices;
  field.video.emplace().is_of_path = is_of_path;
  return field;
}

TEST(RecordingTimes, FramesShowTimesOfTheirClock) {
  EXPECT_EQ(RecordingTimesOf(PathWith("frames: 3\ntime: {from: 2, speed: 0.5}")),
            (std::vector<double>{2, 2.125, 2.25}));
  EXPECT_EQ(RecordingTimesOf(PathWith("frames: 3\ntime: {from: 1, speed: -4}")),
            (std::vector<double>{-1, 0, 1}));
  EXPECT_EQ(RecordingTimesOf(PathWith("frames: 3\ntime: {from: 1, speed: 0}")),
            (std::vector<double>{1}));
  EXPECT_EQ(RecordingTimesOf(PathWith("frames: 2\ntime: {from: 1}")),
            (std::vector<double>{1, 1.25}));
  EXPECT_TRUE(RecordingTimesOf(PathWith("frames: 2")).empty());
}

TEST(RecordingTimes, InstantsShowTheirOwnTimesAndViewsTheSame) {
  EXPECT_EQ(RecordingTimesOf(PathWith(
                "frames: 1\nshutter: {angle_deg: 360, samples: 2}\ntime: {from: 1, speed: 8}")),
            (std::vector<double>{0.5, 1.5}));
  const CameraPath stereo = PathWith("frames: 4\nviews: 2\ntime: {from: 0, speed: 4}");
  EXPECT_EQ(*stereo.cameras[1].recording_time, 0);
  EXPECT_EQ(*stereo.cameras[2].recording_time, 1);
  EXPECT_EQ(*stereo.cameras[3].recording_time, 1);
}

TEST(RecordingTimes, AClockThatIsWrittenIsReadBack) {
  for (const char* const lines :
       {"frames: 5\ntime: {from: 0.1, speed: -0.3}", "frames: 1\ntime: {from: 7, speed: 2}",
        "frames: 6\nviews: 2\ntime: {from: 2, speed: 0.5}"}) {
    const CameraPath path = PathWith(lines);
    const Result<PathYaml> yaml = PathYamlOf(path);
    ASSERT_TRUE(yaml) << yaml.error().message;
    EXPECT_TRUE(yaml->lost.empty()) << lines;
    const Result<CameraPath> read = ParsePathYaml(yaml->text, "written", std::nullopt);
    ASSERT_TRUE(read) << read.error().message;
    for (size_t i = 0; i < path.frame_count(); ++i)
      EXPECT_NEAR(*read->cameras[i].recording_time, *path.cameras[i].recording_time, 1e-12);
  }
  CameraPath uneven = PathWith("frames: 3\ntime: {from: 0}");
  uneven.cameras[1].recording_time = 0.4;
  const Result<PathYaml> yaml = PathYamlOf(uneven);
  ASSERT_TRUE(yaml);
  ASSERT_EQ(yaml->lost.size(), 1u);
  EXPECT_NE(yaml->lost[0].find("time"), std::string::npos);
}

TEST(RecordingTimes, FaultyClocksAreNamed) {
  for (const char* const clock : {"time: 3", "time: {}", "time: {speed: 1}", "time: {from: x}",
                                  "time: {from: 0, sped: 1}", "time: {from: 0, speed: 1e12}"}) {
    const Result<CameraPath> path = ParsePathYaml(
        std::string("format: lfpath 1\nfps: 4\nframes: 2\nresolution: [8, 6]\n") + clock +
            "\ncamera: {position: [0, 0, 0], look_at: [0, 0, 1], "
            "field_of_view_deg: 40}\nlens: {aperture_diameter: 0, "
            "focus_distance: 1}\n",
        "path.yaml", std::nullopt);
    ASSERT_FALSE(path) << clock;
    EXPECT_NE(path.error().message.find("time"), std::string::npos) << path.error().message;
  }
}

TEST(RecordingTimes, APathThatShowsOneSliceNeedsNoTimes) {
  CameraPath path = PathWith("frames: 3\ntime: {from: 1, speed: 0}");
  ASSERT_TRUE(FitToOpenTimes(FieldOf({1}, true), &path));
  EXPECT_TRUE(RecordingTimesOf(path).empty());
  CameraPath moving = PathWith("frames: 3\ntime: {from: 0}");
  ASSERT_TRUE(FitToOpenTimes(FieldOf({0, 0.5}, true), &moving));
  EXPECT_EQ(RecordingTimesOf(moving).size(), 3u);
  CameraPath plain = PathWith("frames: 3");
  EXPECT_TRUE(FitToOpenTimes(FieldOf({1}, false), &plain));
}

TEST(RecordingTimes, OneTimeThatWasChosenOtherwiseIsRefused) {
  CameraPath path = PathWith("frames: 3\ntime: {from: 1}");
  const Result<void> chosen = FitToOpenTimes(FieldOf({1}, false), &path);
  ASSERT_FALSE(chosen);
  EXPECT_EQ(chosen.error().kind, ErrorKind::kUsage);
  EXPECT_NE(chosen.error().message.find("{time}"), std::string::npos);
  EXPECT_FALSE(FitToOpenTimes(LightField(), &path));
}

}  // namespace
}  // namespace lf
