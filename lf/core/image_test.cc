// SPDX-License-Identifier: Apache-2.0
#include "lf/core/image.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(Image, KeepsRowsAndChannelsApart) {
  Image<int> image(3, 2, 2, -1);
  image.at(2, 1, 1) = 7;
  EXPECT_EQ(image.row(1)[5], 7);
  EXPECT_EQ(image.at(2, 1, 0), -1);
  const ImageView<const int> view = image.view();
  EXPECT_EQ(view.at(2, 1, 1), 7);
}

TEST(Bayer, NamesReadRowByRow) {
  EXPECT_EQ(BayerChannel(BayerPattern::kRggb, 0, 0), 0);
  EXPECT_EQ(BayerChannel(BayerPattern::kRggb, 3, 5), 2);
  EXPECT_EQ(BayerChannel(BayerPattern::kGbrg, 1, 0), 2);
  EXPECT_EQ(BayerChannel(BayerPattern::kGbrg, 0, 1), 0);
}

}  // namespace
}  // namespace lf
