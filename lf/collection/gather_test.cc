// SPDX-License-Identifier: Apache-2.0
// Compares the two back ends of the estimator *bilinear* with each other, and with pictures known
// in closed form.
#include "lf/collection/gather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/test_plates.h"

namespace lf {
namespace {

using testing::PlateFor;

LfPixels RandomPixels(const Intrinsics& k, uint64_t seed) {
  LfPixels pixels =
      testing::NoisePixels({0, 0, k.width_px, k.height_px}, BayerPattern::kNone, seed);
  pixels.recorded = static_cast<BayerPattern>(seed % 5);  // only kMosaic reads it
  return pixels;
}

uint64_t GatherInTilesOf(const testing::CameraPair& pair, const LfPixels& recorded, int tile_height,
                         SensorPlate* plate, const PixelReading& reading = PixelFilter::kBicubic) {
  const GatherPlan plan = PlanGather(pair.lf_camera, pair.render_camera, {}, reading);
  const LfPixels pixels = testing::PixelsFor(plan, recorded);
  return testing::InTiles(
      plate, testing::GridOf(*plate, 1 + 3 * tile_height, tile_height),
      [&](size_t /*tile*/, TileSums* sums) { return GatherTile(plan, pixels, sums); });
}

testing::CameraPair RandomPair(uint64_t seed) {
  return seed % 2 == 0 ? testing::RandomCameraPair(seed / 2)
                       : testing::RandomDistortedPair(seed / 2);
}

// Makes elements `factor` times as large, on a plate that is smaller by the same factor.
void MakeCoarser(double factor, RenderCamera* camera) {
  Intrinsics& k = camera->pinhole.intrinsics;
  for (double* value : {&k.fx_px, &k.fy_px, &k.cx_px, &k.cy_px, &k.skew_px}) *value /= factor;
  k.width_px = std::max(1, static_cast<int>(k.width_px / factor));
  k.height_px = std::max(1, static_cast<int>(k.height_px / factor));
}

double Mean(const ElementSum& rays) {
  return static_cast<double>(rays.sum) / static_cast<double>(rays.count);
}

class GatherBy : public ::testing::TestWithParam<PixelFilter> {};
INSTANTIATE_TEST_SUITE_P(Filters, GatherBy,
                         ::testing::Values(PixelFilter::kBicubic, PixelFilter::kPrefiltered));

PixelFilter FilterOf(uint64_t seed) { return static_cast<PixelFilter>(seed % 6); }

TEST(Gather, TheFastBackEndAgreesWithTheReference) {
  uint64_t total = 0, differing_counts = 0, differing_values = 0, scenes_with_rays = 0;
  size_t scenes_of_several = 0, scenes_of_cubics = 0, scenes_of_mosaics = 0;
  for (uint64_t seed = 0; seed < 280; ++seed) {
    testing::CameraPair pair = RandomPair(seed);
    if (seed % 3 == 0) MakeCoarser(1.5 + 0.7 * static_cast<double>(seed % 5), &pair.render_camera);
    const PixelFilter filter = FilterOf(seed / 2);
    PixelReading reading = filter;
    if (seed / 12 % 2 == 1) reading.footprint = PixelFootprint::kPoint;
    const LfPixels pixels = RandomPixels(pair.lf_camera.intrinsics, seed);
    SensorPlate expected = PlateFor(pair), fast = PlateFor(pair);
    const uint64_t accepted =
        GatherReference(pair.lf_camera, pixels, pair.render_camera, &expected, 1, reading);
    GatherInTilesOf(pair, pixels, 120, &fast, reading);
    const GatherSampling sampling = SamplingOf(pair.lf_camera, pair.render_camera, reading);
    scenes_of_several += sampling.samples > 1 && accepted > 0;
    scenes_of_cubics += sampling.filter == PixelFilter::kBicubic && accepted > 0;
    const bool is_prefiltered = !sampling.prefilter.changes_nothing();
    scenes_of_mosaics += filter == PixelFilter::kMosaic && is_prefiltered && accepted > 0;
    total += accepted;
    scenes_with_rays += accepted > 0;
    for (int y = 0; y < expected.height(); ++y)
      for (int x = 0; x < expected.width(); ++x)
        for (int channel = 0; channel < 3; ++channel) {
          const ElementSum a = expected.At(x, y, channel), b = fast.At(x, y, channel);
          differing_counts += a.count != b.count;
          if (a.count != b.count || a == b) continue;
          ++differing_values;
          if (filter == PixelFilter::kNearest) continue;  // rounding may choose another pixel
          // The tolerance is one step (1/256) of the weight along x and one along y, between
          // neighbours that differ by the whole range. Prefilters make differences larger.
          EXPECT_NEAR(Mean(a), Mean(b), 65535. / 128);
        }
  }
  EXPECT_GT(scenes_with_rays, 90u);
  EXPECT_GT(scenes_of_several, 8u);
  EXPECT_GT(scenes_of_cubics, 10u);
  EXPECT_GT(scenes_of_mosaics, 5u);
  EXPECT_GT(total, 150000u);
  EXPECT_LE(static_cast<double>(differing_counts), 1e-5 * static_cast<double>(total));
  // Single precision rounds a few weights in a thousand to another step than the reference does.
  EXPECT_LE(static_cast<double>(differing_values), 5e-3 * static_cast<double>(total));
}

TEST_P(GatherBy, PixelsWithoutARayLendNoLight) {
  testing::CameraPair pair = testing::ParallelPair(3, 2, 0.01, 0.05);
  pair.lf_camera.intrinsics = {100, 100, 100, 70,
                               0,   200, 140, {DistortionModel::kRadialTangential, {-0.9}}};
  pair.render_camera.pinhole.intrinsics = {50, 50, 50, 40, 0, 100, 80};
  const Intrinsics& k = pair.lf_camera.intrinsics;
  const DistortionMap map(k.distortion);
  const LfPixels pixels = RandomPixels(k, 1);
  LfPixels changed = pixels;
  size_t without_ray = 0;
  for (int y = 0; y < k.height_px; ++y)
    for (int x = 0; x < k.width_px; ++x) {
      if (IdealPosition(k, map, x + 0.5, y + 0.5)) continue;
      ++without_ray;
      for (int channel = 0; channel < 3; ++channel) changed.radiance.at(x, y, channel) = 65535;
    }
  EXPECT_GT(without_ray, 5000u);
  SensorPlate plate = PlateFor(pair), plate_of_changed = PlateFor(pair);
  EXPECT_GT(GatherInTilesOf(pair, pixels, 80, &plate, GetParam()), 500u);
  GatherInTilesOf(pair, changed, 80, &plate_of_changed, GetParam());
  EXPECT_EQ(plate, plate_of_changed);
}

TEST(Gather, AnyCutIntoTilesGivesTheSameBits) {
  for (uint64_t seed = 0; seed < 100; ++seed) {
    testing::CameraPair pair = RandomPair(seed);
    if (seed % 3 == 0) MakeCoarser(1.5 + 0.7 * static_cast<double>(seed % 5), &pair.render_camera);
    const PixelFilter filter = FilterOf(seed / 2);
    const LfPixels pixels = RandomPixels(pair.lf_camera.intrinsics, seed);
    SensorPlate whole = PlateFor(pair), cut = PlateFor(pair);
    const uint64_t accepted = GatherInTilesOf(pair, pixels, 120, &whole, filter);
    EXPECT_EQ(GatherInTilesOf(pair, pixels, 7, &cut, filter), accepted);
    EXPECT_EQ(whole, cut) << seed;
  }
}

// A wall in focus whose radiance is linear in the plane: bilinear interpolation is exact (nearly,
// with lens distortion), so every element has the radiance of the wall at its focus point.
TEST_P(GatherBy, AWallInFocusReproducesItself) {
  const PixelFilter filter = GetParam();
  for (const Distortion& distortion :
       {Distortion{}, Distortion{DistortionModel::kRadialTangential, {-0.2, 0.05, 0.002, -0.001}},
        Distortion{DistortionModel::kFisheye, {0.01, -0.004}}}) {
    testing::CameraPair pair = testing::ParallelPair(3, 2, 0.01, 0.05);
    pair.lf_camera.intrinsics = {400, 400, 101, 69, 0.3, 200, 140, distortion};
    const Intrinsics& k = pair.lf_camera.intrinsics;
    const auto wall = [](const Vec3& point) {
      return 30000 + 20000 * point.x() - 15000 * point.y();
    };
    LfPixels pixels = RandomPixels(k, 0);
    const DistortionMap map(distortion);
    const Vec3 centre = pair.lf_camera.CentreWorld();
    for (int y = 0; y < k.height_px; ++y)
      for (int x = 0; x < k.width_px; ++x) {
        const Vec3 distorted = k.InverseMatrix() * Vec3(x + 0.5, y + 0.5, 1);
        const Vec3 d = *map.Undistort(distorted.head<2>());
        const double v = wall(centre + d * (2 / d.z()));
        for (int channel = 0; channel < 3; ++channel)
          pixels.radiance.at(x, y, channel) = static_cast<uint16_t>(std::lround(v));
      }
    SensorPlate plate = PlateFor(pair);
    const uint64_t accepted = GatherInTilesOf(pair, pixels, 35, &plate, filter);
    EXPECT_GT(accepted, 1200u);
    size_t tested = 0;
    for (int y = 0; y < plate.height(); ++y)
      for (int x = 0; x < plate.width(); ++x) {
        const ElementSum element = plate.At(x, y, 1);
        // At the border of the LF image, a prefilter lacks pixels.
        constexpr int kBorder = 3;
        const auto is_seen = [&](int u, int v) {
          return u >= 0 && v >= 0 && u < plate.width() && v < plate.height() &&
                 plate.At(u, v, 1).count > 0;
        };
        if (element.count == 0 || !is_seen(x - kBorder, y) || !is_seen(x + kBorder, y) ||
            !is_seen(x, y - kBorder) || !is_seen(x, y + kBorder))
          continue;
        ++tested;
        const Vec3 point = *FocusPointOfElement(pair.render_camera, x + 0.5, y + 0.5);
        // From one LF pixel to the next, radiance changes by up to 100. The tolerance is half a
        // step of the weights, and rounding.
        EXPECT_NEAR(static_cast<double>(element.sum), wall(point), 2.5) << x << ", " << y;
      }
    EXPECT_GT(tested, 800u);
  }
}

TEST(Gather, AllFourPixelsMustExistAndBeUnmasked) {
  const Intrinsics k{100, 100, 4, 3, 0, 8, 6};
  LfPixels pixels = RandomPixels(k, 1);
  EXPECT_FALSE(InterpolatePixels(pixels, 8, 6, 0.49, 3));
  EXPECT_TRUE(InterpolatePixels(pixels, 8, 6, 0.5, 3));
  EXPECT_TRUE(InterpolatePixels(pixels, 8, 6, 7.49, 3));
  EXPECT_FALSE(InterpolatePixels(pixels, 8, 6, 7.5, 3));
  EXPECT_FALSE(InterpolatePixels(pixels, 8, 6, 4, 5.6));
  pixels.Mask(3, 2);
  EXPECT_FALSE(InterpolatePixels(pixels, 8, 6, 4, 3));
  EXPECT_TRUE(InterpolatePixels(pixels, 8, 6, 5, 3));
}

TEST(Gather, BicubicTakesTheFourWhereTheSixteenAreNot) {
  const Intrinsics k{100, 100, 4, 3, 0, 8, 6};
  LfPixels pixels = RandomPixels(k, 3);
  const auto at = [&](double x, double y, PixelFilter filter) {
    return InterpolatePixels(pixels, 8, 6, x, y, {filter, filter == PixelFilter::kBicubic});
  };
  const auto is_bilinear = [&](double x, double y) {
    EXPECT_TRUE(at(x, y, PixelFilter::kBicubic));
    return at(x, y, PixelFilter::kBicubic) == at(x, y, PixelFilter::kBilinear);
  };
  EXPECT_TRUE(is_bilinear(1.2, 3.3));
  EXPECT_TRUE(is_bilinear(6.7, 3.3));
  EXPECT_TRUE(is_bilinear(4.2, 5.1));
  EXPECT_FALSE(is_bilinear(4.2, 3.3));
  pixels.Mask(2, 1);
  EXPECT_TRUE(is_bilinear(4.2, 3.3));
  // Both back ends are compared on images with masked pixels. Most images are so small that every
  // pixel is near the border.
  for (const int size : {2, 3, 4, 5, 40}) {
    testing::CameraPair pair = testing::ParallelPair(1, 3, 0.01, 0.05);
    Intrinsics& small = pair.lf_camera.intrinsics;
    small = {0.1 * size, 0.1 * size, 0.5 * size, 0.5 * size, 0, size, size, {}};
    small.fx_px = small.fy_px = 100.0 * size / 200;
    LfPixels few = RandomPixels(small, static_cast<uint64_t>(size));
    for (int i = 7; i < size; i += 9) few.Mask(i, i);
    SensorPlate expected = PlateFor(pair), fast = PlateFor(pair);
    const uint64_t accepted = GatherReference(pair.lf_camera, few, pair.render_camera, &expected, 1,
                                              PixelFilter::kBicubic);
    EXPECT_GT(accepted, 100u) << size;
    EXPECT_EQ(GatherInTilesOf(pair, few, 9, &fast, PixelFilter::kBicubic), accepted);
    uint64_t differing = 0;
    for (int y = 0; y < expected.height(); ++y)
      for (int x = 0; x < expected.width(); ++x)
        differing += expected.At(x, y, 1) == fast.At(x, y, 1) ? 0 : 1;
    EXPECT_LE(differing, accepted / 50);
  }
}

TEST_P(GatherBy, MaskedPixelsTakeTheRaysAroundThem) {
  const PixelFilter filter = GetParam();
  // Half a pixel of disparity per pitch: every ray lies between pixels.
  const testing::CameraPair pair = testing::ParallelPair(1, 3, 0.01, 0.05);
  LfPixels pixels = RandomPixels(pair.lf_camera.intrinsics, 4);
  SensorPlate expected = PlateFor(pair), fast = PlateFor(pair), all = PlateFor(pair);
  const uint64_t unmasked = GatherInTilesOf(pair, pixels, 9, &all, filter);
  for (int i = 5; i < 30; i += 3) pixels.Mask(i, i);
  const uint64_t accepted =
      GatherReference(pair.lf_camera, pixels, pair.render_camera, &expected, 1, filter);
  EXPECT_LT(accepted, unmasked - 20);
  EXPECT_EQ(GatherInTilesOf(pair, pixels, 9, &fast, filter), accepted);
  for (int y = 0; y < expected.height(); ++y)
    for (int x = 0; x < expected.width(); ++x)
      EXPECT_EQ(fast.At(x, y, 1).count, expected.At(x, y, 1).count) << x << ", " << y;
}

TEST(Gather, InterpolationIsExactAtCentresAndHalfway) {
  const Intrinsics k{100, 100, 4, 3, 0, 8, 6};
  const LfPixels pixels = RandomPixels(k, 2);
  const auto at_centre = InterpolatePixels(pixels, 8, 6, 2.5, 3.5);
  const auto halfway = InterpolatePixels(pixels, 8, 6, 3, 3.5);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ((*at_centre)[c], pixels.radiance.at(2, 3, c));
    EXPECT_EQ((*halfway)[c], (pixels.radiance.at(2, 3, c) + pixels.radiance.at(3, 3, c) + 1) / 2);
  }
}

}  // namespace
}  // namespace lf
