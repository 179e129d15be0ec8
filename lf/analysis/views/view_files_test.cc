// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/views/view_files.h"

#include <gtest/gtest.h>

#include <limits>

#include "lf/light_field/model/radiance.h"

namespace lf {
namespace {

// The 16-bit radiance of LF images keeps every 8-bit value.
TEST(ViewFile, GivesEachDisplayValueBack) {
  RadianceEncoding encoding;
  const std::vector<uint16_t> table = RadianceTable(encoding, 8, 1);
  for (uint32_t value = 0; value < 256; ++value) {
    const auto light = static_cast<float>(table[value] / encoding.Scale());
    EXPECT_EQ(DisplayNumber(light, 255), value);
  }
}

TEST(ViewFile, ClipsWhatADisplayCannotShow) {
  EXPECT_EQ(DisplayNumber(-0.1F, 255), 0u);
  EXPECT_EQ(DisplayNumber(7, 65535), 65535u);
  EXPECT_EQ(DisplayNumber(std::numeric_limits<float>::quiet_NaN(), 255), 0u);
}

TEST(ViewFile, IsNamedByRowColumnAndPosition) {
  LightField capture;
  capture.intrinsics.push_back({100, 100, 32, 24, 0, 64, 48});
  for (int i = 0; i < 9; ++i) {
    LfCamera camera;
    camera.cam_from_world.translation = -Vec3(0.25 * (i % 3), 0.5 * (i / 3), 0);
    capture.cameras.push_back(camera);
    capture.image_names.push_back("a.png");
  }
  const auto grid = ViewGrid::Make(capture, 3, 3);
  ASSERT_TRUE(grid);
  EXPECT_EQ(ViewName(*grid, 2, 0.1, ViewValues::kSrgb8), "out_00_02_-50.000000_25.000000.png");
  EXPECT_EQ(ViewName(*grid, 4, 1, ViewValues::kLinear), "out_01_01_0.000000_0.000000.exr");
  EXPECT_EQ(FilesOfViews(*grid, "views", 1, ViewValues::kSrgb16).size(), 11u);
}

}  // namespace
}  // namespace lf
