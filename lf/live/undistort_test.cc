// SPDX-License-Identifier: Apache-2.0
#include "lf/live/undistort.h"

#include <gtest/gtest.h>

#include <vector>

#include "lf/camera/ideal_pixels.h"

namespace lf {
namespace {

Intrinsics Lens(DistortionModel model, const DistortionParameters& parameters, double fx_px = 100) {
  Intrinsics k = {fx_px, 105, 61, 44, 0, 120, 90};
  k.distortion = {model, parameters};
  return k;
}

const Intrinsics kBarrel = Lens(DistortionModel::kRadialTangential, {-0.2, 0.05, 0.002, -0.003});
const Intrinsics kPincushion = Lens(DistortionModel::kRadialTangential, {0.12});
const Intrinsics kFisheye = Lens(DistortionModel::kFisheye, {-0.02, 0.004});

double Brightness(double x, double y) { return 20000 + 9000 * x - 7000 * y; }

// An LF image whose light is a linear function of the direction.
LfPixels Ramp(const Intrinsics& k) {
  LfPixels pixels({0, 0, k.width_px, k.height_px}, BayerPattern::kNone);
  const DistortionMap map(k.distortion);
  for (int y = 0; y < k.height_px; ++y)
    for (int x = 0; x < k.width_px; ++x) {
      const Vec3 q = k.InverseMatrix() * *IdealPosition(k, map, x + 0.5, y + 0.5);
      for (int channel = 0; channel < 3; ++channel)
        pixels.radiance.at(x, y, channel) =
            static_cast<uint16_t>(Brightness(q.x() / q.z(), q.y() / q.z()) + 1000 * channel);
    }
  return pixels;
}

TEST(Undistort, LightArrivesFromTheSameDirections) {
  for (const Intrinsics& k : {kBarrel, kPincushion, kFisheye}) {
    const Intrinsics pinhole = *CommonPinhole(std::vector{k});
    LfPixels out;
    Undistort(Ramp(k), k, pinhole, &out);
    EXPECT_FALSE(out.any_masked);
    double most = 0;
    for (int y = 0; y < pinhole.height_px; ++y)
      for (int x = 0; x < pinhole.width_px; ++x) {
        const Vec3 d = pinhole.InverseMatrix() * Vec3(x + 0.5, y + 0.5, 1);
        for (int channel = 0; channel < 3; ++channel)
          most = std::max(most, std::abs(out.radiance.at(x, y, channel) - Brightness(d.x(), d.y()) -
                                         1000 * channel));
      }
    EXPECT_LT(most, 4) << static_cast<int>(k.distortion.model);  // a pixel is 80 wide
    EXPECT_GT(pinhole.width_px * pinhole.height_px, 0.7 * k.width_px * k.height_px);
  }
}

TEST(Undistort, AnLfImageWithoutDistortionLosesHalfAPixelAtItsBorders) {
  const Intrinsics k = Lens(DistortionModel::kNone, {});
  const Intrinsics pinhole = *CommonPinhole(std::vector{k});
  EXPECT_EQ(pinhole.width_px, 119);
  EXPECT_EQ(pinhole.height_px, 89);
  EXPECT_NEAR(pinhole.cx_px, 60.5, 1e-9);
}

TEST(Undistort, AllLensesSeeTheCommonImage) {
  const std::vector<Intrinsics> lenses = {kBarrel, kPincushion, kFisheye};
  const Intrinsics pinhole = *CommonPinhole(lenses);
  for (const Intrinsics& k : lenses) {
    LfPixels out;
    Undistort(Ramp(k), k, pinhole, &out);
    EXPECT_FALSE(out.any_masked);
  }
  // A telephoto lens sees a small part of what a wide one sees.
  EXPECT_FALSE(
      CommonPinhole(std::vector{kBarrel, Lens(DistortionModel::kRadialTangential, {0.01}, 400)}));
}

TEST(Undistort, MaskedPixelsMaskThoseThatTheyTouch) {
  LfPixels pixels = Ramp(kBarrel);
  pixels.Mask(60, 44);
  LfPixels out;
  Undistort(pixels, kBarrel, *CommonPinhole(std::vector{kBarrel}), &out);
  int masked = 0;
  for (int y = 0; y < out.rect.height(); ++y)
    for (int x = 0; x < out.rect.width(); ++x) masked += out.IsMasked(x, y) ? 1 : 0;
  EXPECT_TRUE(out.any_masked);
  EXPECT_GE(masked, 2);
  EXPECT_LE(masked, 9);
}

}  // namespace
}  // namespace lf
