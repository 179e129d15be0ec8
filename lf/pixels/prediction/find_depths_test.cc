// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/find_depths.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr int kWidth = 640, kHeight = 420;

// A camera at `position` that looks along z.
PinholeView ViewAt(const Vec3& position) {
  PinholeView view;
  view.intrinsics << 500, 0, kWidth / 2, 0, 500, kHeight / 2, 0, 0, 1;
  view.cam_from_world.translation = -position;
  return view;
}

// A texture with detail of several sizes, as a function of a place in the plane.
double Texture(double x, double y, uint64_t stream) {
  double sum = 0;
  for (int octave = 0; octave < 4; ++octave) {
    const double size = 40.0 / (1 << octave);
    const double u = x / size + 1000, v = y / size + 1000;
    const auto column = static_cast<uint64_t>(u), row = static_cast<uint64_t>(v);
    const double a = u - std::floor(u), b = v - std::floor(v);
    const auto at = [&](uint64_t i, uint64_t j) {
      return RandomUnit(stream, static_cast<uint64_t>(octave), (column + i) * 100000 + row + j);
    };
    sum += (at(0, 0) * (1 - a) + at(1, 0) * a) * (1 - b) + (at(0, 1) * (1 - a) + at(1, 1) * a) * b;
  }
  return sum / 4;
}

// Draws a wall at inverse depth `far`, before which a board at inverse depth `near` hides what
// lies right of x = 0.
Image<uint8_t> Drawn(const PinholeView& view, double far, double near) {
  Image<uint8_t> image(kWidth, kHeight);
  const Vec3 position = -view.cam_from_world.translation;
  const Mat3 to_ray = view.intrinsics.inverse();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Vec3 ray = to_ray * Vec3(x + 0.5, y + 0.5, 1);
      const Vec3 board = position + ray / near, wall = position + ray / far;
      const double value = board.x() > 0
                               ? Texture(500 * near * board.x(), 500 * near * board.y(), 1)
                               : Texture(500 * far * wall.x(), 500 * far * wall.y(), 2);
      image.at(x, y) = static_cast<uint8_t>(255 * value);
    }
  return image;
}

TEST(FindInverseDepths, TheRangeIsThatOfTheScene) {
  for (const Vec3& apart : {Vec3(0.1, 0, 0), Vec3(-0.07, 0.07, 0), Vec3(0.02, -0.2, 0.03)}) {
    constexpr double kFar = 0.2, kNear = 0.5;
    const PinholeView view = ViewAt({0, 0, 0}), other = ViewAt(apart);
    const InverseDepthRange found =
        FindInverseDepths(Drawn(view, kFar, kNear), view, Drawn(other, kFar, kNear), other);
    EXPECT_LE(found.least, kFar);
    EXPECT_GE(found.greatest, kNear);
    // Not much more: two steps of what was found first, and pixels of the whole image.
    const double pixel = 1 / (500 * apart.norm());
    EXPECT_GT(found.least, kFar - 4 * pixel);
    EXPECT_LT(found.greatest, kNear + 4 * pixel);
  }
}

TEST(FindInverseDepths, PicturesWithoutDetailGiveTheWholeRange) {
  const PinholeView view = ViewAt({0, 0, 0}), other = ViewAt({0.1, 0, 0});
  const Image<uint8_t> grey(kWidth, kHeight, 1, 90);
  const InverseDepthRange found = FindInverseDepths(grey, view, grey, other);
  EXPECT_LT(found.least, 0);
  // A quarter of the width.
  EXPECT_NEAR(found.greatest * 500 * 0.1, kWidth / 4.0, 1);
}

TEST(FindInverseDepths, EqualPositionsHaveAnyRange) {
  const PinholeView view = ViewAt({1, 2, 3});
  const Image<uint8_t> image = Drawn(view, 0.1, 0.3);
  const InverseDepthRange found = FindInverseDepths(image, view, image, view);
  EXPECT_EQ(found.least, 0);
  EXPECT_EQ(found.greatest, 1);
}

TEST(FindInverseDepths, TinyPicturesAreNoErrors) {
  const PinholeView view = ViewAt({0, 0, 0}), other = ViewAt({0.1, 0, 0});
  const Image<uint8_t> tiny(3, 2);
  const InverseDepthRange found = FindInverseDepths(tiny, view, tiny, other);
  EXPECT_GT(found.greatest, found.least);
}

}  // namespace
}  // namespace lf
