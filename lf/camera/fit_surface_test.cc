// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/fit_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lf {
namespace {

TEST(FitSurface, APlaneIsOnePiece) {
  Image<float> q(100, 70);
  for (int y = 0; y < 70; ++y)
    for (int x = 0; x < 100; ++x)
      q.at(x, y) = static_cast<float>(0.3 + 1e-3 * (x + 0.5) - 5e-4 * (y + 0.5));
  const FittedSurface fitted = FitSurface(q, {.blur_px_w = 1000});
  ASSERT_EQ(fitted.surface.pieces().size(), 1u);
  const FocalPiece& piece = fitted.surface.pieces()[0];
  EXPECT_NEAR(piece.inverse_depth.x(), 1e-3, 1e-9);
  EXPECT_NEAR(piece.inverse_depth.y(), -5e-4, 1e-9);
  EXPECT_NEAR(piece.inverse_depth.z(), 0.3, 1e-7);
  EXPECT_LT(fitted.most_blur_px, 1e-3);
  EXPECT_EQ(fitted.beyond_count, 0u);
}

// A step between two depths is followed to the least side, and no farther.
TEST(FitSurface, AStepIsFollowedDownToTheLeastSide) {
  Image<float> q(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) q.at(x, y) = x < 21 ? 0.5F : 0.25F;
  const FittedSurface fitted = FitSurface(q, {.blur_px_w = 100, .least_side_px = 2});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      if (x / 2 == 10) continue;  // the squares that the step divides
      EXPECT_FLOAT_EQ(static_cast<float>(fitted.surface.PieceAt(x, y).At(x + 0.5, y + 0.5)),
                      q.at(x, y));
    }
  EXPECT_LE(fitted.beyond_count, 128u);
  // A single side of the least squares is out of focus, by the median or the plane.
  EXPECT_LE(fitted.most_blur_px, 25.0 + 1e-6);
  EXPECT_LT(fitted.surface.pieces().size(), 200u);
}

TEST(FitSurface, NoElementIsBlurredMoreThanAskedIfThereAreEnoughPieces) {
  Image<float> q(128, 96);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 128; ++x)
      q.at(x, y) = static_cast<float>(0.3 + 0.05 * std::sin(x * 0.06) * std::cos(y * 0.05));
  const FittedSurface fine =
      FitSurface(q, {.blur_px_w = 500, .most_blur_px = 0.5, .most_pieces = 10'000});
  EXPECT_LE(fine.most_blur_px, 0.5);
  EXPECT_EQ(fine.beyond_count, 0u);
  EXPECT_LT(fine.surface.pieces().size(), 96u * 128u / 16);
  const FittedSurface coarse =
      FitSurface(q, {.blur_px_w = 500, .most_blur_px = 0.5, .most_pieces = 40});
  EXPECT_LE(coarse.surface.pieces().size(), 40u);
  EXPECT_GT(coarse.most_blur_px, 0.5);
  EXPECT_GT(coarse.beyond_count, 0u);
  EXPECT_GT(coarse.mean_blur_px, fine.mean_blur_px);
}

// The plane through the elements of a steep slope reaches behind the lens at a corner of its
// square.
TEST(FitSurface, NoPieceReachesBehindTheLens) {
  Image<float> q(2, 2);
  q.at(0, 0) = 1e-3F;
  q.at(1, 0) = 1;
  q.at(0, 1) = 1;
  q.at(1, 1) = 2;
  const FittedSurface fitted = FitSurface(q, {.blur_px_w = 1});
  for (const FocalPiece& piece : fitted.surface.pieces())
    for (const int y : {piece.elements.y_begin, piece.elements.y_end})
      for (const int x : {piece.elements.x_begin, piece.elements.x_end})
        EXPECT_GT(piece.At(x, y), 0);
}

TEST(FillUnknown, UnknownDepthsTakeTheNearestKnownOne) {
  Image<float> q(5, 3);
  std::fill(q.pixels().begin(), q.pixels().end(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(FillUnknown(&q), 15u);
  EXPECT_TRUE(std::isnan(q.at(2, 1)));
  q.at(0, 1) = 0.5F;
  q.at(4, 1) = 0.25F;
  q.at(1, 0) = -1;
  q.at(1, 1) = std::numeric_limits<float>::infinity();
  EXPECT_EQ(FillUnknown(&q), 13u);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) {
      if (x == 2) continue;
      EXPECT_EQ(q.at(x, y), x < 2 ? 0.5F : 0.25F) << x << " " << y;
    }
}

}  // namespace
}  // namespace lf
