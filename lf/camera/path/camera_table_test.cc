// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/camera_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/camera/path/test_path.h"

namespace lf {
namespace {

CameraPath Path() {
  TestPath path;
  path.clock = "fps: 10\nframes: 3\nresolution: [200, 100]\n";
  path.pose = "position: [0, 0, -2], speed: [1, 0, 0], look_at: [0, 0, 0], follow: direction";
  const auto parsed = path.Parse();
  EXPECT_TRUE(parsed) << parsed.error().message;
  return *parsed;
}

TEST(CameraTable, WhatIsConstantStandsOnceAboveTheTable) {
  const CameraPath path = Path();
  const std::string table = CameraTable(path, path.frames().All());
  EXPECT_NE(table.find("focus_distance_w"), std::string::npos) << table;
  const std::string rows = table.substr(table.find("\n\n"));
  EXPECT_EQ(rows.find("focus_distance_w"), std::string::npos) << table;
  EXPECT_NE(rows.find("position_w"), std::string::npos) << table;
  // An empty line, two header lines and three frames.
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 7) << table;
}

TEST(CameraTable, CsvHasALineForEachFrame) {
  const CameraPath path = Path();
  const std::string csv = CameraCsv(path, {{1}, {3}});
  EXPECT_EQ(csv.substr(0, 13), "frame,time_s,");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3) << csv;
  EXPECT_NE(csv.find("\n3,0.2,"), std::string::npos) << csv;
}

TEST(CameraTable, JsonHasTheWholeFilmButOnlyTheseCameras) {
  const std::string json = CameraJson(Path(), {{2}});
  EXPECT_NE(json.find("\"frames\": 3"), std::string::npos) << json;
  EXPECT_NE(json.find("\"frame\": 2"), std::string::npos) << json;
  EXPECT_EQ(json.find("\"frame\": 1"), std::string::npos) << json;
}

TEST(CameraTable, ABlockHasOneFactPerLine) {
  const std::string block = CameraBlock(Path(), {2});
  EXPECT_EQ(block.substr(0, 24), "frame                 2\n") << block;
}

}  // namespace
}  // namespace lf
