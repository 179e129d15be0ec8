// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/fill_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

struct Picture {
  Image<float> values;
  Image<float> weight;
};

// Returns a picture of two channels in which a pixel has the value of_place(x, y) and its double,
// and of whose pixels the share `known` is known, at random.
template <class OfPlace>
Picture Make(int width, int height, double known, const OfPlace& of_place) {
  Picture picture{Image<float>(width, height, 2), Image<float>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool is_known =
          RandomUnit(3, static_cast<uint64_t>(y), static_cast<uint64_t>(x)) < known;
      picture.weight.at(x, y) = is_known ? 1 : 0;
      // Values that are not known must have no effect.
      picture.values.at(x, y, 0) = is_known ? of_place(x, y) : -1e6F;
      picture.values.at(x, y, 1) = is_known ? 2 * of_place(x, y) : 1e6F;
    }
  return picture;
}

TEST(FillPixels, KnownPixelsStayAndTheOthersAreBetweenThem) {
  for (const auto& [width, height] : {std::pair(33, 18), std::pair(1, 7), std::pair(64, 1)}) {
    const auto noise = [](int x, int y) {
      return static_cast<float>(RandomUnit(5, static_cast<uint64_t>(y), static_cast<uint64_t>(x)));
    };
    Picture picture = Make(width, height, 0.3, noise);
    picture.weight.at(0, 0) = 1;
    picture.values.at(0, 0, 0) = 0.5F;
    picture.values.at(0, 0, 1) = 1;
    const Picture before = picture;
    FillPixels(&picture.values, picture.weight);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (picture.weight.at(x, y) == 1) {
          EXPECT_EQ(picture.values.at(x, y, 0), before.values.at(x, y, 0));
        }
        EXPECT_GE(picture.values.at(x, y, 0), 0);
        EXPECT_LE(picture.values.at(x, y, 0), 1);
        EXPECT_NEAR(picture.values.at(x, y, 1), 2 * picture.values.at(x, y, 0), 1e-5);
      }
  }
}

TEST(FillPixels, AFlatPictureIsExactAndASlopeIsNear) {
  Picture flat = Make(70, 51, 0.02, [](int, int) { return 0.75F; });
  FillPixels(&flat.values, flat.weight);
  for (const float value : flat.values.pixels()) EXPECT_TRUE(value == 0.75F || value == 1.5F);
  const auto slope = [](int x, int y) { return 0.01F * static_cast<float>(x + y); };
  Picture picture = Make(120, 90, 0.2, slope);
  FillPixels(&picture.values, picture.weight);
  double squares = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x) squares += std::pow(picture.values.at(x, y, 0) - slope(x, y), 2);
  // Known pixels are about two pixels apart, over which the slope changes by 0.03.
  EXPECT_LT(std::sqrt(squares / (120 * 90)), 0.02);
}

TEST(FillPixels, NothingKnownIsBlack) {
  Picture picture = Make(9, 6, 0, [](int, int) { return 1.0F; });
  FillPixels(&picture.values, picture.weight);
  for (const float value : picture.values.pixels()) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace lf
