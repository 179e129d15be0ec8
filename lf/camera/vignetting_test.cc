// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/vignetting.h"

#include <gtest/gtest.h>

#include "lf/camera/pinhole.h"

namespace lf {
namespace {

Intrinsics IntrinsicsWith(const Vignetting& vignetting) {
  Intrinsics k;
  k.fx_px = k.fy_px = 500;
  k.cx_px = 400;
  k.cy_px = 300;
  k.width_px = 800;
  k.height_px = 600;
  k.vignetting = vignetting;
  return k;
}

TEST(Vignetting, ACornerOfACentralCameraHasRadiusOne) {
  EXPECT_EQ(RadiusSquared(IntrinsicsWith({}), 0, 0), 1);
  EXPECT_EQ(RadiusSquared(IntrinsicsWith({}), 800, 600), 1);
  EXPECT_EQ(RadiusSquared(IntrinsicsWith({}), 400, 300), 0);
  EXPECT_DOUBLE_EQ(RadiusSquared(IntrinsicsWith({}), 800, 300), 0.64);
}

TEST(Vignetting, TheFalloffIsThePolynomialOfEvenPowers) {
  const Vignetting falloff{{-0.3, 0.05, -0.15}};
  EXPECT_EQ(falloff.Falloff(0), 1);
  EXPECT_DOUBLE_EQ(falloff.Falloff(1), 0.6);
  EXPECT_DOUBLE_EQ(falloff.Falloff(0.25), 1 - 0.075 + 0.003125 - 0.00234375);
}

TEST(Vignetting, TheRangeHoldsEveryPixelAndIsReached) {
  for (const Vignetting& falloff :
       {Vignetting{{-0.3, 0.05, -0.15}}, Vignetting{{-1.5, 2.2, -0.9}}, Vignetting{{-1, 0.8, 0}},
        Vignetting{{0.4, 0, 0}}, Vignetting{}})
    for (const double cx : {400., 100., -300.}) {
      Intrinsics k = IntrinsicsWith(falloff);
      k.cx_px = cx;
      const FalloffRange range = FalloffRangeOf(k);
      double least = 10, most = 0;
      for (int y = 0; y <= 600; ++y)
        for (int x = 0; x <= 800; ++x) {
          const double share = falloff.Falloff(RadiusSquared(k, x, y));
          least = std::min(least, share);
          most = std::max(most, share);
        }
      EXPECT_LE(range.min, least + 1e-12);
      EXPECT_GE(range.max, most - 1e-12);
      EXPECT_NEAR(range.min, least, 1e-4);
      EXPECT_NEAR(range.max, most, 1e-4);
    }
}

TEST(Vignetting, ALensThatLosesAllLightIsNone) {
  EXPECT_TRUE(IsFalloff(IntrinsicsWith({{-0.9, 0, 0}})));
  EXPECT_FALSE(IsFalloff(IntrinsicsWith({{-1, 0, 0}})));
  EXPECT_FALSE(IsFalloff(IntrinsicsWith({{-4, 4, 0}})));  // F is 0 at r = 0.7, but 1 in the corners
  EXPECT_FALSE(IsFalloff(IntrinsicsWith({{100, 0, 0}})));
}

}  // namespace
}  // namespace lf
