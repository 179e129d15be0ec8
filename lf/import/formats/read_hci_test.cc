// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_hci.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

const std::string kText = R"([intrinsics]
focal_length_mm = 100.0
image_resolution_x_px = 512
image_resolution_y_px = 384
sensor_size_mm = 35.0
fstop = 100.0

[extrinsics]
num_cams_x = 9
num_cams_y = 7
baseline_mm = 90.0
focus_distance_m = 10.0
center_cam_x_m = 1.5

# a comment = 3
[meta]
scene = boxes
disp_min = -1.6
disp_max = 2.4
)";

LightField ParsedHci(const std::string& text) {
  Result<LightField> light_field = ParseHci(text, "f/parameters.cfg");
  EXPECT_TRUE(light_field) << light_field.error().message;
  return light_field ? *std::move(light_field) : LightField{};
}

// Returns the text with the line of a key replaced; the line becomes blank if `with` is empty.
std::string Changed(const std::string& key, const std::string& with) {
  std::string text = kText;
  const size_t begin = text.find(key), end = text.find('\n', begin);
  return text.replace(begin, end - begin, with);
}

void ExpectHciError(const std::string& text, const std::vector<std::string>& parts) {
  const Result<LightField> light_field = ParseHci(text, "f/parameters.cfg");
  ASSERT_FALSE(light_field) << text;
  const std::string& message = light_field.error().message;
  EXPECT_EQ(message.find("f/parameters.cfg: "), 0u) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

TEST(ReadHci, IsAGridRowByRowFromTheUpperLeft) {
  const LightField field = ParsedHci(kText);
  ASSERT_EQ(field.size(), 63u);
  EXPECT_EQ(field.image_names[0], "input_Cam000.png");
  EXPECT_EQ(field.image_names[62], "input_Cam062.png");
  EXPECT_NEAR((field.Camera({0}).CentreWorld() - Vec3(-0.36, -0.27, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((field.Camera({1}).CentreWorld() - Vec3(-0.27, -0.27, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((field.Camera({9}).CentreWorld() - Vec3(-0.36, -0.18, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(field.folder, "f");
}

TEST(ReadHci, ThePlaneOfFocusStandsStillInAllImages) {
  const LightField field = ParsedHci(kText);
  const Intrinsics middle = field.Camera({31}).intrinsics;
  EXPECT_NEAR(middle.fx_px, 100.0 / 35 * 512, 1e-9);
  EXPECT_EQ(middle.cx_px, 256);
  EXPECT_EQ(middle.cy_px, 192);
  const Vec3 on_plane(0.7, -0.4, 10), nearer(0.7, -0.4, 8);
  const Vec2 seen = *Project(field.Camera({31}), on_plane);
  for (uint32_t i = 0; i < field.size(); ++i)
    EXPECT_NEAR((*Project(field.Camera({i}), on_plane) - seen).norm(), 0, 1e-9);
  // From one column to the next, a nearer point moves to the left by the disparity.
  const double moved =
      Project(field.Camera({31}), nearer)->x() - Project(field.Camera({32}), nearer)->x();
  EXPECT_NEAR(moved, middle.fx_px * 0.09 * (1. / 8 - 1. / 10), 1e-9);
}

TEST(ReadHci, DisparitiesTellTheDepthRange) {
  const LightField field = ParsedHci(kText);
  ASSERT_TRUE(field.depth_range);
  const double fb = 100.0 / 35 * 512 * 0.09;
  EXPECT_NEAR(field.depth_range->near_w, fb / (fb / 10 + 2.45), 1e-9);
  EXPECT_NEAR(field.depth_range->far_w, fb / (fb / 10 - 1.65), 1e-9);
  EXPECT_FALSE(ParsedHci(Changed("disp_max", "")).depth_range);
  EXPECT_FALSE(ParsedHci(Changed("disp_min", "disp_min = -14")).depth_range) << "beyond infinity";
}

TEST(ReadHci, AFocusAtInfinityLeavesThePrincipalPointsInTheMiddle) {
  const LightField field = ParsedHci(Changed("focus_distance_m", "focus_distance_m=0"));
  EXPECT_EQ(field.intrinsics.size(), 1u);
  EXPECT_EQ(field.intrinsics[0].cx_px, 256);
}

TEST(ReadHci, ErrorsNameKeyAndValue) {
  ExpectHciError("", {"focal_length_mm is missing", "4D Light Field Benchmark"});
  ExpectHciError(Changed("num_cams_x", "num_cams_x = nine"), {"num_cams_x is \"nine\"", "1 to"});
  ExpectHciError(Changed("num_cams_y", "num_cams_y = 2.5"), {"num_cams_y is \"2.5\""});
  ExpectHciError(Changed("num_cams_y", "num_cams_y = 9e9"), {"num_cams_y", "1 to"});
  ExpectHciError(Changed("baseline_mm", "baseline_mm = -3"), {"baseline_mm is \"-3\""});
  ExpectHciError(Changed("focal_length_mm", "focal_length_mm = nan"),
                 {"focal_length_mm is \"nan\""});
  ExpectHciError(Changed("disp_min", "disp_min = x"), {"disp_min is \"x\""});
  ExpectHciError(Changed("sensor_size_mm", "sensor_size_mm = 0.001") + "\nfocal_length_mm = 1e5",
                 {"the focal length comes to"});
}

class OpenHciTest : public FolderTest {};

TEST_F(OpenHciTest, FoldersAndFilesAreOpened) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "parameters.cfg", kText));
  EXPECT_EQ(OpenLightField(folder_)->size(), 63u);
  EXPECT_EQ(OpenLightField(folder_ / "parameters.cfg")->size(), 63u);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "parameters.cfg", "[blender]\nsamples = 3\n"));
  EXPECT_FALSE(OpenLightField(folder_));
}

}  // namespace
}  // namespace lf
