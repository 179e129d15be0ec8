// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/working_image.h"

#include <gtest/gtest.h>

#include "lf/densify/test_world.h"

namespace lf {
namespace {

constexpr int kPixels = 8;
constexpr uint16_t kHalfOpacity = (LfPixels::kTransparent + LfPixels::kOpaque) / 2;

PinholeCamera SmallCamera() { return CameraAt(0, 0, kPixels, kPixels); }

// Returns grey pixels with an opacity.
LfPixels PixelsOf(uint16_t radiance, uint16_t opacity) {
  LfPixels pixels({0, 0, kPixels, kPixels}, BayerPattern::kNone);
  pixels.opacity.Resize(kPixels, kPixels, LfPixels::kRgbLanes);
  for (size_t i = 0; i < pixels.radiance.pixels().size(); ++i) {
    const bool is_ray = i % LfPixels::kRgbLanes == LfPixels::kRayLane;
    pixels.radiance.pixels()[i] = is_ray ? uint16_t{1} : radiance;
    pixels.opacity.pixels()[i] = is_ray ? uint16_t{1} : opacity;
  }
  return pixels;
}

void SetOpacity(int x, int y, uint16_t opacity, LfPixels* pixels) {
  for (int c = 0; c < LfPixels::kRayLane; ++c) pixels->opacity.at(x, y, c) = opacity;
}

TEST(WorkingImage, LightIsWithTheOpacityOfEachPixel) {
  LfPixels pixels = PixelsOf(20000, LfPixels::kOpaque);
  SetOpacity(1, 0, kHalfOpacity, &pixels);
  SetOpacity(2, 0, LfPixels::kTransparent, &pixels);
  pixels.Mask(3, 0);
  const WorkingImage image = WorkingImageOf(SmallCamera(), pixels, 1, ToneCurve({}));
  EXPECT_EQ(image.light.at(0, 0, 0), 20000);
  EXPECT_EQ(image.light.at(0, 0, 3), kOpaqueOpacity);
  EXPECT_EQ(image.light.at(1, 0, 3), 1 + kMostOpacity / 2);
  EXPECT_EQ(image.light.at(2, 0, 3), 1);
  for (int lane = 0; lane < 4; ++lane) EXPECT_EQ(image.light.at(3, 0, lane), 0);
  pixels.opacity = {};
  const WorkingImage opaque = WorkingImageOf(SmallCamera(), pixels, 1, ToneCurve({}));
  EXPECT_EQ(opaque.light.at(2, 0, 3), kOpaqueOpacity);
  EXPECT_EQ(opaque.light.at(3, 0, 3), 0);
  EXPECT_TRUE(opaque.empty.empty());
}

TEST(WorkingImage, EveryAlphaOf8BitsIsKept) {
  for (uint32_t alpha = 0; alpha < 256; ++alpha) {
    const auto opacity =
        static_cast<uint16_t>(LfPixels::kTransparent +
                              (alpha * (LfPixels::kOpaque - LfPixels::kTransparent) + 127) / 255);
    const WorkingImage image =
        WorkingImageOf(SmallCamera(), PixelsOf(0, opacity), 1, ToneCurve({}));
    EXPECT_EQ((image.light.at(4, 4, 3) - 1 + 128) / 257, static_cast<int>(alpha));
  }
}

TEST(WorkingImage, ReducedPixelsAreMeansOfLightAndOpacity) {
  LfPixels pixels = PixelsOf(20000, LfPixels::kOpaque);
  for (int y = 0; y < 2; ++y) {
    SetOpacity(0, y, LfPixels::kTransparent, &pixels);
    for (int c = 0; c < 3; ++c) pixels.radiance.at(0, y, c) = 0;
  }
  pixels.Mask(3, 0);
  const WorkingImage image = WorkingImageOf(SmallCamera(), pixels, 2, ToneCurve({}));
  EXPECT_EQ(image.light.at(0, 0, 1), 10000);
  EXPECT_EQ(image.light.at(0, 0, 3), 1 + kMostOpacity / 2);
  EXPECT_EQ(image.light.at(1, 0, 3), 0) << "one of its four pixels is masked";
  EXPECT_EQ(image.light.at(2, 0, 3), kOpaqueOpacity);
}

TEST(WorkingImage, AnUndistortedOutlineHasTheColourOfTheObject) {
  LfPixels pixels = PixelsOf(20000, LfPixels::kOpaque);
  for (int y = 0; y < kPixels; ++y)
    for (int x = kPixels / 2; x < kPixels; ++x) {
      SetOpacity(x, y, LfPixels::kTransparent, &pixels);
      for (int c = 0; c < 3; ++c) pixels.radiance.at(x, y, c) = 0;
    }
  PinholeCamera camera = SmallCamera();
  camera.intrinsics.fx_px = camera.intrinsics.fy_px = 4;
  camera.intrinsics.cx_px += 1.5;
  camera.intrinsics.distortion = {DistortionModel::kRadialTangential, {-0.6}};
  const WorkingImage image = WorkingImageOf(camera, pixels, 1, ToneCurve({}));
  bool is_between = false;
  for (int x = 0; x < kPixels; ++x) {
    const uint16_t* pixel = &image.light.at(x, 4);
    const double opacity = (pixel[3] - 1.0) / kMostOpacity;
    is_between |= opacity > 0.05 && opacity < 0.95;
    EXPECT_NEAR(pixel[0], 20000 * opacity, 2) << x;
  }
  EXPECT_TRUE(is_between);
}

TEST(WorkingImage, TransparentAndMaskedPixelsHaveDifferentTones) {
  LfPixels pixels = PixelsOf(0, LfPixels::kTransparent);
  pixels.Mask(0, 0);
  SetOpacity(1, 0, LfPixels::kOpaque, &pixels);
  const WorkingImage image = WorkingImageOf(SmallCamera(), pixels, 1, ToneCurve({}));
  EXPECT_EQ(image.tones.at(0, 0, 3), 0);
  EXPECT_EQ(image.tones.at(1, 0, 3), 255);
  EXPECT_EQ(image.tones.at(2, 0, 3), kTransparentTone);
  EXPECT_FALSE(IsTransparent(&image.tones.at(0, 0)));
  EXPECT_FALSE(IsTransparent(&image.tones.at(1, 0))) << "black";
  EXPECT_TRUE(IsTransparent(&image.tones.at(2, 0)));
  EXPECT_EQ(ShownCount(image.tones), 2u);
  // Pixels beside a masked or an opaque one may be those of an outline.
  EXPECT_EQ(image.empty.at(2, 0), 0);
  EXPECT_EQ(image.empty.at(2, 1), 0);
  EXPECT_EQ(image.empty.at(3, 0), 1);
  EXPECT_EQ(image.empty.at(2, 2), 1);
}

TEST(WorkingImage, LightWithoutOpacityIsSeen) {
  const WorkingImage image =
      WorkingImageOf(SmallCamera(), PixelsOf(20000, LfPixels::kTransparent), 1, ToneCurve({}));
  EXPECT_FALSE(IsTransparent(&image.tones.at(2, 2)));
  EXPECT_TRUE(image.empty.empty());
}

TEST(TextureAt, CountsInsideTheObjectAndNotAtItsOutline) {
  WorkingImage image = ImageOfDisk(CameraAt(0, 0), {2, 0.3, 0.6, false});
  for (int y = 1; y < image.height() - 1; ++y)
    for (int x = 1; x < image.width() - 1; ++x)
      ASSERT_LT(TextureAt(image.tones, x, y), 14) << x << " " << y;
  image.tones.at(48, 32, 1) += 50;
  EXPECT_EQ(TextureAt(image.tones, 49, 32), 50);
}

TEST(WithOpacities, KeepsTheAlphaOfEveryBackground) {
  LightField field;
  field.encoding.background = {0, 1, 0};
  EXPECT_EQ(WithOpacities(field).encoding, field.encoding);
  field.encoding.alpha = AlphaMeaning::kPremultiplied;
  const RadianceEncoding kept = WithOpacities(field).encoding;
  EXPECT_TRUE(kept.HasOpacity());
  EXPECT_EQ(kept.Background(), (std::array{0., 0., 0.}));
}

}  // namespace
}  // namespace lf
