// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/upright.h"

#include <gtest/gtest.h>

#include <vector>

namespace lf {
namespace {

// The stored picture is
//   1 2 3
//   4 5 6
TEST(Upright, TurnsAsTheTagSays) {
  Image<int> stored(3, 2);
  stored.pixels() = {1, 2, 3, 4, 5, 6};
  const std::vector<LargeVector<int>> expected = {
      {1, 4, 2, 5, 3, 6}, {4, 1, 5, 2, 6, 3}, {6, 3, 5, 2, 4, 1}, {3, 6, 2, 5, 1, 4}};
  for (int orientation = 5; orientation <= 8; ++orientation) {
    const Image<int> upright = Upright(stored, orientation);
    EXPECT_EQ(upright.width(), 2);
    EXPECT_EQ(upright.height(), 3);
    EXPECT_EQ(upright.pixels(), expected[orientation - 5]) << orientation;
  }
}

TEST(Upright, ChannelsStayTogether) {
  Image<int> stored(2, 1, 2);
  stored.pixels() = {1, 2, 3, 4};
  EXPECT_EQ(Upright(stored, 8).pixels(), (LargeVector<int>{3, 4, 1, 2}));
}

TEST(Upright, PartsKeepTheirPlaces) {
  Image<int> stored(5, 4);
  for (int i = 0; i < 20; ++i) stored.pixels()[i] = i;
  for (int orientation = 5; orientation <= 8; ++orientation) {
    const Image<int> upright = Upright(stored, orientation);
    const PixelRect wanted = {1, 2, 3, 5};  // a part of the 4 x 5 upright picture
    const PixelRect rect = StoredRect(wanted, 5, 4, orientation);
    EXPECT_EQ(UprightRect(rect, 5, 4, orientation), wanted);
    Image<int> part(rect.width(), rect.height());
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x)
        part.at(x, y) = stored.at(rect.x_begin + x, rect.y_begin + y);
    const Image<int> turned = Upright(part, orientation);
    for (int y = 0; y < wanted.height(); ++y)
      for (int x = 0; x < wanted.width(); ++x)
        EXPECT_EQ(turned.at(x, y), upright.at(wanted.x_begin + x, wanted.y_begin + y));
  }
}

}  // namespace
}  // namespace lf
