// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/gather_sampling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/magnification.h"
#include "lf/camera/testing_scenes.h"
#include "lf/collection/cubic_weights.h"
#include "lf/collection/gather.h"
#include "lf/collection/test_plates.h"

namespace lf {
namespace {

// Returns a pair of cameras whose LF pixels are `magnification` times as large as elements.
testing::CameraPair PairOf(double magnification) {
  testing::CameraPair pair = testing::ParallelPair(3, 2, 0.01, 0.05);
  const Intrinsics& plate = pair.render_camera.pinhole.intrinsics;
  // For parallel cameras, the magnification is the ratio of focal lengths, at any depth.
  const double focal = plate.fx_px / magnification;
  const int width = static_cast<int>(plate.width_px / magnification) + 40;
  const int height = static_cast<int>(plate.height_px / magnification) + 40;
  pair.lf_camera.intrinsics = {focal, focal, 0.5 * width, 0.5 * height, 0, width, height, {}};
  return pair;
}

TEST(GatherSampling, MagnificationIsElementsPerLfPixel) {
  for (const double magnification : {0.11, 0.5, 0.77, 1.0, 2.5}) {
    const testing::CameraPair pair = PairOf(magnification);
    EXPECT_NEAR(Magnification(pair.lf_camera, pair.render_camera), magnification,
                1e-6 * magnification);
  }
  // This LF camera sees nothing of the frame.
  testing::CameraPair pair = PairOf(1);
  pair.lf_camera.cam_from_world.translation += Vec3(1000, 0, 0);
  EXPECT_NEAR(Magnification(pair.lf_camera, pair.render_camera), 1, 1e-6);
}

TEST(GatherSampling, TakesAsManySamplesAsLfPixelsAreSmaller) {
  const auto of = [](double magnification, PixelFilter filter = PixelFilter::kBicubic) {
    const testing::CameraPair pair = PairOf(magnification);
    return SamplingOf(pair.lf_camera, pair.render_camera, filter);
  };
  EXPECT_EQ(of(3).samples, 1);
  EXPECT_EQ(of(0.81).samples, 1);
  EXPECT_EQ(of(0.79).samples, 2);
  EXPECT_EQ(of(0.5).samples, 2);
  EXPECT_EQ(of(0.49).samples, 3);
  EXPECT_EQ(of(0.01).samples, kMostSamples);
  EXPECT_EQ(of(0.3).filter, PixelFilter::kBicubic);
  EXPECT_TRUE(of(0.3).is_cubic);
  EXPECT_EQ(of(2, PixelFilter::kNearest).filter, PixelFilter::kNearest);
}

TEST(GatherSampling, TheFilterAutoDependsOnTheLightField) {
  RadianceEncoding mosaic, brackets;
  mosaic.bayer = BayerPattern::kRggb;
  brackets.masks_clipped = true;
  EXPECT_EQ(FilterOf(PixelFilter::kAuto, {}), PixelFilter::kPrefiltered);
  EXPECT_EQ(FilterOf(PixelFilter::kAuto, mosaic), PixelFilter::kMosaic);
  EXPECT_EQ(FilterOf(PixelFilter::kAuto, brackets), PixelFilter::kBicubic);
  EXPECT_EQ(FilterOf(PixelFilter::kBicubic, mosaic), PixelFilter::kBicubic);
}

TEST(GatherSampling, APrefilterReplacesSamples) {
  for (const double magnification : {3.0, 1.0, 0.5, 0.2}) {
    const testing::CameraPair pair = PairOf(magnification);
    const GatherSampling sampling =
        SamplingOf(pair.lf_camera, pair.render_camera, PixelFilter::kPrefiltered);
    EXPECT_EQ(sampling.filter, PixelFilter::kPrefiltered);
    EXPECT_EQ(sampling.samples, 1);
    EXPECT_EQ(sampling.prefilter, PrefilterFor(1 / magnification, PixelFootprint::kArea));
  }
}

TEST(GatherSampling, MosaicsArePrefilteredAfterTheirCorrection) {
  for (const double magnification : {3.0, 1.0, 0.79, 0.5, 0.1})
    for (const auto footprint : {PixelFootprint::kArea, PixelFootprint::kPoint}) {
      const testing::CameraPair pair = PairOf(magnification);
      PixelReading reading = PixelFilter::kMosaic;
      reading.footprint = footprint;
      reading.correction = 2;
      const GatherSampling sampling = SamplingOf(pair.lf_camera, pair.render_camera, reading);
      Prefilter expected = PrefilterFor(1 / magnification, footprint);
      expected.correction = 2;
      EXPECT_EQ(sampling.prefilter, expected);
      EXPECT_EQ(sampling.filter, PixelFilter::kPrefiltered);
      EXPECT_EQ(sampling.samples, 1);
      EXPECT_FALSE(sampling.is_cubic);
      reading.filter = PixelFilter::kPrefiltered;
      EXPECT_EQ(SamplingOf(pair.lf_camera, pair.render_camera, reading).prefilter.correction, 0);
    }
}

// The corners of this LF image lie beyond the fold of its distortion. Its pixels are corrected, but
// elements are the means of bilinear samples.
TEST(GatherSampling, MosaicsThatMayLackRaysAreOnlyCorrected) {
  testing::CameraPair pair = PairOf(0.5);
  Intrinsics& k = pair.lf_camera.intrinsics;
  k.distortion = {DistortionModel::kRadialTangential, {-0.9}};
  k.width_px = k.height_px = static_cast<int>(2 * k.fx_px);
  k.cx_px = k.cy_px = k.fx_px;
  ASSERT_TRUE(MayLackRays(k));
  PixelReading reading = PixelFilter::kMosaic;
  reading.correction = 3;
  const GatherSampling sampling = SamplingOf(pair.lf_camera, pair.render_camera, reading);
  EXPECT_EQ(sampling.filter, PixelFilter::kBilinear);
  EXPECT_FALSE(sampling.is_cubic);
  EXPECT_GT(sampling.samples, 1);
  Prefilter expected;
  expected.correction = 3;
  EXPECT_EQ(sampling.prefilter, expected);
}

// Elements may be wider than any integer, in LF pixels, because a frame may show the light field
// from very far away or from its side.
TEST(GatherSampling, TheNumberOfSamplesIsBounded) {
  for (const double magnification : {1e-2, 1e-7, 1e-12}) {
    const testing::CameraPair pair = PairOf(magnification);
    EXPECT_EQ(SamplingOf(pair.lf_camera, pair.render_camera, PixelFilter::kBicubic).samples,
              kMostSamples)
        << magnification;
  }
}

// Noise of LF pixels that are much finer than elements averages out. If an element had one sample,
// all of the noise would be left.
TEST(GatherSampling, FinePixelsAverage) {
  for (const PixelFilter filter : {PixelFilter::kBicubic, PixelFilter::kPrefiltered}) {
    const testing::CameraPair pair = PairOf(0.25);
    const LfPixels pixels = testing::NoisePixels(testing::WholeImage(pair), BayerPattern::kNone, 1);
    SensorPlate plate = testing::PlateFor(pair);
    ASSERT_GT(GatherReference(pair.lf_camera, pixels, pair.render_camera, &plate, 1, filter),
              1000u);
    double squares = 0, count = 0;
    for (int y = 0; y < plate.height(); ++y)
      for (int x = 0; x < plate.width(); ++x) {
        const ElementSum element = plate.At(x, y, 1);
        if (element.count == 0) continue;
        ASSERT_EQ(element.count, 1u);
        squares += std::pow(static_cast<double>(element.sum) - 32767.5, 2);
        ++count;
      }
    // Uniform noise has a standard deviation of 65536 / sqrt(12). The mean of 4 x 4 samples has a
    // quarter of that, or less.
    EXPECT_LT(std::sqrt(squares / count), 65536 / std::sqrt(12.0) / 4 * 1.15);
  }
}

TEST(CubicWeights, SumToOneAndReproduceParabolas) {
  for (int step = 0; step <= kCubicSteps; ++step)
    for (const int bits : {kCubicDownBits, kCubicRightBits}) {
      const CubicTaps taps = CubicTapsAt(step, bits);
      EXPECT_EQ(taps[0] + taps[1] + taps[2] + taps[3], 1 << bits);
      const double t = static_cast<double>(step) / kCubicSteps;
      double linear = 0, square = 0;
      for (int i = 0; i < 4; ++i) {
        linear += taps[i] * (i - 1.0) / (1 << bits);
        square += taps[i] * (i - 1.0) * (i - 1.0) / (1 << bits);
      }
      EXPECT_NEAR(linear, t, 1e-3);
      EXPECT_NEAR(square, t * t, 3e-3);
    }
  EXPECT_EQ(CubicTapsAt(0, 12), (CubicTaps{0, 4096, 0, 0}));
  EXPECT_EQ(CubicTapsAt(kCubicSteps, 12), (CubicTaps{0, 0, 4096, 0}));
}

TEST(PixelFilter, ConstantPicturesStayWhatTheyAre) {
  for (const double magnification : {2.0, 0.5, 0.3})
    for (const PixelFilter filter :
         {PixelFilter::kBicubic, PixelFilter::kMosaic, PixelFilter::kPrefiltered})
      for (const uint16_t value : {0, 1, 777, 32768, 65535}) {
        const testing::CameraPair pair = PairOf(magnification);
        LfPixels pixels(testing::WholeImage(pair), BayerPattern::kNone);
        pixels.recorded = BayerPattern::kGrbg;
        for (int y = 0; y < pixels.rect.height(); ++y)
          for (int x = 0; x < pixels.rect.width(); ++x)
            for (int c = 0; c < 3; ++c) pixels.radiance.at(x, y, c) = value;
        SensorPlate plate = testing::PlateFor(pair);
        const GatherPlan plan = PlanGather(pair.lf_camera, pair.render_camera, {}, filter);
        pixels = testing::PixelsFor(plan, pixels);
        const auto gather = [&](size_t /*tile*/, TileSums* sums) {
          return GatherTile(plan, pixels, sums);
        };
        EXPECT_GT(testing::InTiles(&plate, testing::GridOf(plate, 64, 16), gather), 1000u);
        for (int y = 0; y < plate.height(); ++y)
          for (int x = 0; x < plate.width(); ++x) {
            const ElementSum element = plate.At(x, y, 2);
            EXPECT_EQ(element.sum, element.count * value);
          }
      }
}

}  // namespace
}  // namespace lf
