// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/fill_pixels.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

struct Picture {
  std::vector<Image<float>> planes;
  Image<float> weight;
};

// Returns a picture of two planes in which a pixel has the value of_place(x, y) and its double, and
// of whose pixels the share `known` is known, at random.
template <class OfPlace>
Picture Make(int width, int height, double known, const OfPlace& of_place) {
  Picture picture{std::vector<Image<float>>(2, Image<float>(width, height)),
                  Image<float>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool is_known =
          RandomUnit(3, static_cast<uint64_t>(y), static_cast<uint64_t>(x)) < known;
      picture.weight.at(x, y) = is_known ? 1 : 0;
      // Values that are not known must have no effect.
      picture.planes[0].at(x, y) = is_known ? of_place(x, y) : -1e6F;
      picture.planes[1].at(x, y) = is_known ? 2 * of_place(x, y) : 1e6F;
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
    picture.planes[0].at(0, 0) = 0.5F;
    picture.planes[1].at(0, 0) = 1;
    const Picture before = picture;
    FillPixels(&picture.planes, picture.weight);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (picture.weight.at(x, y) == 1) {
          EXPECT_EQ(picture.planes[0].at(x, y), before.planes[0].at(x, y));
        }
        EXPECT_GE(picture.planes[0].at(x, y), 0);
        EXPECT_LE(picture.planes[0].at(x, y), 1);
        EXPECT_NEAR(picture.planes[1].at(x, y), 2 * picture.planes[0].at(x, y), 1e-5);
      }
  }
}

TEST(FillPixels, AFlatPictureIsExactAndASlopeIsNear) {
  Picture flat = Make(70, 51, 0.02, [](int, int) { return 0.75F; });
  FillPixels(&flat.planes, flat.weight);
  for (const float value : flat.planes[0].pixels()) EXPECT_NEAR(value, 0.75F, 1e-6F);
  const auto slope = [](int x, int y) { return 0.01F * static_cast<float>(x + y); };
  Picture picture = Make(120, 90, 0.2, slope);
  FillPixels(&picture.planes, picture.weight);
  double squares = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x) squares += std::pow(picture.planes[0].at(x, y) - slope(x, y), 2);
  // Known pixels are about two pixels apart, over which the slope changes by 0.03.
  EXPECT_LT(std::sqrt(squares / (120 * 90)), 0.02);
}

TEST(FillPixels, HasTheSameBitsWithAllInstructions) {
  std::vector<Image<float>> first;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    const auto noise = [](int x, int y) {
      return static_cast<float>(RandomUnit(6, static_cast<uint64_t>(y), static_cast<uint64_t>(x)));
    };
    Picture picture = Make(77, 31, 0.1, noise);
    FillPixels(&picture.planes, picture.weight);
    if (first.empty()) first = picture.planes;
    for (size_t i = 0; i < first.size(); ++i)
      EXPECT_EQ(picture.planes[i].pixels(), first[i].pixels()) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

TEST(FillPixels, NothingKnownIsBlack) {
  Picture picture = Make(9, 6, 0, [](int, int) { return 1.0F; });
  FillPixels(&picture.planes, picture.weight);
  for (const float value : picture.planes[1].pixels()) EXPECT_EQ(value, 0);
}

// A light of which all pixels are known, and a ring of dark pixels around it. One in 20 of the
// pixels beyond is known and dark.
TEST(FillPixels, LightStaysInsideAKnownRing) {
  const auto distance = [](int x, int y) { return std::hypot(x - 40.5, y - 37.0); };
  Picture picture =
      Make(96, 80, 0.05, [&](int x, int y) { return distance(x, y) < 5 ? 100.0F : 0.0F; });
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 96; ++x)
      if (distance(x, y) < 7) {
        picture.weight.at(x, y) = 1;
        picture.planes[0].at(x, y) = distance(x, y) < 5 ? 100 : 0;
      }
  FillPixels(&picture.planes, picture.weight);
  double spread = 0;
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 96; ++x)
      if (distance(x, y) >= 7) spread += picture.planes[0].at(x, y);
  // The light has 78 pixels. Reduced pictures alone, without means of neighbours, spread 0.22 of
  // it.
  EXPECT_LT(spread, 0.06 * 78 * 100);
}

}  // namespace
}  // namespace lf
