// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/quilt_devices.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lf {
namespace {

TEST(QuiltDevices, ViewsHaveTheAspectOfTheDisplayAndNoFewerPixelsThanATile) {
  for (const QuiltDevice& device : QuiltDevices()) {
    const ViewSize view = device.view(), tile = device.tile();
    EXPECT_GE(view.width, tile.width) << device.name;
    EXPECT_GE(view.height, tile.height) << device.name;
    EXPECT_TRUE(view.width == tile.width || view.height == tile.height) << device.name;
    const double aspect = static_cast<double>(device.aspect_width) / device.aspect_height;
    EXPECT_NEAR(static_cast<double>(view.width) / view.height, aspect, 0.002 * aspect)
        << device.name;
    EXPECT_EQ(&QuiltDeviceNamed(device.name), &device);
  }
  EXPECT_EQ(NamesOfQuiltDevices().size(), QuiltDevices().size());
}

TEST(QuiltDevices, TilesAreThoseOfTheMaker) {
  EXPECT_EQ(QuiltDeviceNamed("portrait").tile(), (ViewSize{420, 560}));
  EXPECT_EQ(QuiltDeviceNamed("portrait").view(), (ViewSize{420, 560}));
  EXPECT_EQ(QuiltDeviceNamed("go").tile(), (ViewSize{372, 682}));
  EXPECT_EQ(QuiltDeviceNamed("go").view(), (ViewSize{384, 682}));
  EXPECT_EQ(QuiltDeviceNamed("16-landscape").tile(), (ViewSize{857, 857}));
  EXPECT_EQ(QuiltDeviceNamed("16-landscape").view(), (ViewSize{1524, 857}));
  EXPECT_EQ(QuiltDeviceNamed("65").tile(), (ViewSize{1024, 910}));
}

}  // namespace
}  // namespace lf
