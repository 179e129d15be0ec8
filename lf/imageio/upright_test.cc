#include "lf/imageio/upright.h"

#include <gtest/gtest.h>

#include <vector>

namespace lf {
namespace {

// 1 2 3
// 4 5 6
TEST(Upright, TurnsAsTheTagSays) {
  Image<int> stored(3, 2);
  stored.pixels() = {1, 2, 3, 4, 5, 6};
  const std::vector<std::vector<int>> expected = {
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
  EXPECT_EQ(Upright(stored, 8).pixels(), (std::vector<int>{3, 4, 1, 2}));
}

}  // namespace
}  // namespace lf
