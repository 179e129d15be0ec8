// SPDX-License-Identifier: Apache-2.0
#include "lf/live/shrink.h"

#include <gtest/gtest.h>

#include "lf/collection/prefilter/prefilter.h"
#include "lf/core/random.h"
#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

LfPixels Noise(int width, int height) {
  LfPixels pixels({0, 0, width, height}, BayerPattern::kNone);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        pixels.radiance.at(x, y, c) =
            static_cast<uint16_t>(RandomBits(5, 0, static_cast<uint64_t>((y * width + x) * 3 + c)));
  return pixels;
}

TEST(Shrink, PixelsAreMeansOfUnmaskedPixels) {
  LfPixels pixels = Noise(11, 8);
  pixels.Mask(0, 0);                                          // 8 of 9 pixels are left
  for (int i = 0; i < 5; ++i) pixels.Mask(3 + i % 3, i / 3);  // 4 of 9 pixels are left
  LfPixels shrunken;
  Shrink(pixels, 3, &shrunken);
  ASSERT_EQ(shrunken.rect, (PixelRect{0, 0, 3, 2}));
  EXPECT_TRUE(shrunken.any_masked);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      double sum = 0, count = 0;
      for (int i = 0; i < 9; ++i)
        if (!pixels.IsMasked(3 * x + i % 3, 3 * y + i / 3)) {
          sum += pixels.radiance.at(3 * x + i % 3, 3 * y + i / 3, 1);
          ++count;
        }
      const bool is_masked = x == 1 && y == 0;
      EXPECT_EQ(shrunken.IsMasked(x, y), is_masked);
      EXPECT_NEAR(shrunken.radiance.at(x, y, 1), is_masked ? 0 : sum / count, 0.501);
      EXPECT_EQ(shrunken.radiance.at(x, y, LfPixels::kRayLane), is_masked ? 0 : 1);
    }
}

TEST(Shrink, OneKeepsThePixelsAndTinyImagesKeepOne) {
  const LfPixels pixels = Noise(5, 4);
  LfPixels same, tiny;
  Shrink(pixels, 1, &same);
  EXPECT_EQ(same.radiance.pixels(), pixels.radiance.pixels());
  EXPECT_FALSE(same.any_masked);
  Shrink(pixels, 16, &tiny);
  EXPECT_EQ(tiny.rect, (PixelRect{0, 0, 1, 1}));
  EXPECT_FALSE(tiny.any_masked);
}

// A pixel of the shrunken LF image looks in the direction of the middle of its square.
TEST(Shrink, CamerasOfShrunkenImagesSeeTheSame) {
  const LightField field = testing::NoiseField(), shrunk = ShrunkField(field, 4);
  EXPECT_EQ(shrunk.intrinsics[0].width_px, 16);
  const Ray full = RayOfPixel(field.Camera(LfImageId{7}), 10, 22);
  const Ray small = RayOfPixel(shrunk.Camera(LfImageId{7}), 2.5, 5.5);
  EXPECT_LT((full.direction - small.direction).norm(), 1e-12);
}

TEST(Shrink, ElementsAreAboutAPixelWide) {
  const LightField field = testing::NoiseField();
  const ImageIndex index(field);
  for (const int width : {80, 40, 30, 20, 10, 7, 5}) {
    const RenderCamera frame = WithPlateWidth(testing::NoiseFrames()[0], width, 1000);
    const double element_px =
        70.0 / width;  // the focal length is as many LF pixels as the plate is wide
    const int divisor = DivisorFor(index, frame, 0);
    EXPECT_LE(element_px / divisor, kFinerAtMost + 1e-3) << width;
    EXPECT_GT(element_px / divisor, divisor == 1 ? 0.8 : kFinerAtMost / 2) << width;
  }
  const RenderCamera frame = WithPlateWidth(testing::NoiseFrames()[0], 30, 1000);
  EXPECT_EQ(DivisorFor(index, frame, 0), 2);
  EXPECT_EQ(DivisorFor(index, frame, 3), 3);  // the current one still suits
  EXPECT_EQ(DivisorFor(index, frame, 1), 2);
  EXPECT_EQ(DivisorFor(index, frame, 9), 2);
  // Elements become a little wider, and then much wider.
  const RenderCamera wider = WithPlateWidth(testing::NoiseFrames()[0], 52, 1000);
  EXPECT_EQ(DivisorFor(index, wider, 0), 2);
  EXPECT_EQ(DivisorFor(index, wider, 1), 1);
  EXPECT_EQ(DivisorFor(index, WithPlateWidth(testing::NoiseFrames()[0], 40, 1000), 1), 2);
}

TEST(Shrink, PlatesKeepThePictureWithinTheLimits) {
  const RenderCamera frame = testing::NoiseFrames()[0];
  const RenderCamera half = WithPlateWidth(frame, 40, 1000);
  EXPECT_EQ(half.pinhole.intrinsics.width_px, 40);
  EXPECT_EQ(half.pinhole.intrinsics.height_px, 30);
  EXPECT_DOUBLE_EQ(half.pinhole.intrinsics.fx_px, 40);
  EXPECT_DOUBLE_EQ(half.pinhole.intrinsics.cy_px, 15);
  EXPECT_EQ(WithPlateWidth(frame, 5000, 60).pinhole.intrinsics.width_px, 60);
  RenderCamera tall = frame;
  tall.pinhole.intrinsics.height_px = 100'000;
  EXPECT_EQ(WithPlateWidth(tall, 80, 100).pinhole.intrinsics.height_px, 100);
  EXPECT_EQ(WithPlateWidth(tall, 80, 100).pinhole.intrinsics.width_px, 1);
}

}  // namespace
}  // namespace lf
