// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/rebin_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lf/camera/testing_scenes.h"
#include "lf/core/random.h"
#include "lf/rebinning/pixel_chances.h"

namespace lf {
namespace {

Slab TestSlab() {
  Slab slab;
  slab.uv.origin_world = Vec3(0, 0, 1);
  slab.r_st_w = 1e-3;
  slab.r_uv_w = 2e-3;
  return slab;
}

PinholeCamera TestCamera(const Distortion& distortion = {}) {
  PinholeCamera camera;
  camera.intrinsics = {90, 91, 41, 29, 0.5, 80, 60, distortion};
  camera.cam_from_world = *LookAlong(Vec3(0.01, -0.02, 0.03), Vec3(0.1, -0.05, 1), -Vec3::UnitY());
  return camera;
}

LfPixels NoiseAt(const PixelRect& rect, BayerPattern bayer) {
  LfPixels pixels(rect, bayer);
  for (int y = 0; y < rect.height(); ++y)
    for (int x = 0; x < rect.width(); ++x)
      for (int c = 0; c < std::min(3, pixels.radiance.channels()); ++c)
        pixels.radiance.at(x, y, c) =
            static_cast<uint16_t>(RandomBits(3, (rect.y_begin + y) * 4096 + rect.x_begin + x, c));
  return pixels;
}

std::multiset<CellKey> Keys(const BinnedRays& rays) {
  std::multiset<CellKey> keys;
  for (size_t shard = 0; shard < RayMap::kShards; ++shard)
    for (const BinnedRay& ray : rays.kept[shard]) {
      EXPECT_EQ(RayMap::ShardOf(ray.cell), shard);
      keys.insert(ray.cell);
    }
  return keys;
}

size_t CountOf(const std::array<std::vector<BinnedRay>, RayMap::kShards>& shards) {
  size_t count = 0;
  for (const auto& shard : shards) count += shard.size();
  return count;
}

RebinOptions Every() {
  RebinOptions options;
  options.probability = {0, 0, 0, 0.999999, 0};
  return options;
}

// Returns the number of pixels whose ray is not in the cell of CellOf(Parameterize(ray)).
size_t Misplaced(const PinholeCamera& camera, const IdealPixels* ideal) {
  const Slab slab = TestSlab();
  const PixelRect rect{0, 0, 80, 60};
  const LfPixels pixels = NoiseAt(rect, BayerPattern::kNone);
  BinnedRays rays;
  RebinImage(slab, camera, {3}, pixels, rect, StoredValueTable({}), ideal, Every(), nullptr,
             RayMap(10), &rays);
  EXPECT_EQ(rays.looked_at, 80u * 60);
  const std::multiset<CellKey> found = Keys(rays);
  PinholeCamera without = camera;
  without.intrinsics.distortion = {};
  const DistortionMap map(camera.intrinsics.distortion);
  size_t missing = 0;
  std::multiset<CellKey> expected;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) {
      Vec3 position(x + 0.5, y + 0.5, 1);
      if (ideal != nullptr) position = *IdealPosition(camera.intrinsics, map, x + 0.5, y + 0.5);
      const auto point = Parameterize(
          slab, RayOfPixel(without, position.x() / position.z(), position.y() / position.z()));
      expected.insert(*CellOf(slab, *point));
    }
  EXPECT_EQ(found.size(), expected.size());
  for (const CellKey key : expected) missing += found.count(key) == 0 ? 1 : 0;
  return missing;
}

TEST(RebinImage, RaysAreInTheirCells) { EXPECT_LE(Misplaced(TestCamera(), nullptr), 2u); }

TEST(RebinImage, AlsoThroughALensThatBendsThem) {
  Distortion distortion;
  distortion.model = DistortionModel::kRadialTangential;
  distortion.parameters[0] = 0.05;
  const PinholeCamera camera = TestCamera(distortion);
  const IdealPixels ideal(camera.intrinsics);
  EXPECT_LE(Misplaced(camera, &ideal), 20u);
}

TEST(RebinImage, KeepsAsManyAsItsProbabilitiesSay) {
  const PixelRect rect{0, 0, 80, 60};
  const LfPixels pixels = NoiseAt(rect, BayerPattern::kNone);
  const std::vector<uint16_t> table = StoredValueTable({});
  RebinOptions options;
  options.probability = {1, 0.5, 0, 0.1, 0};
  double expected = 0;
  Image<uint16_t> map;
  ProbabilityMap(pixels, pixels.rect, table, options.probability, &map);
  for (const uint16_t p : map.pixels()) expected += p / 65535.0;
  double sum = 0;
  std::multiset<CellKey> first;
  for (uint32_t i = 0; i < 20; ++i) {
    options.seed = i / 10;
    BinnedRays rays;
    RebinImage(TestSlab(), TestCamera(), {i % 10}, pixels, rect, table, nullptr, options, nullptr,
               RayMap(10), &rays);
    sum += static_cast<double>(CountOf(rays.kept));
    EXPECT_EQ(CountOf(rays.others), 0u);
    if (i == 0)
      first = Keys(rays);
    else
      EXPECT_NE(Keys(rays), first);  // another LF image or seed keeps other rays
  }
  EXPECT_NEAR(sum / 20, expected, 4 * std::sqrt(expected / 20));
}

TEST(PixelChances, TheFastOnesAreThoseOfSinglePixels) {
  const PixelChances chances(3, LfImageId{7});
  RandomSequence random(2);
  std::vector<uint32_t> chosen;
  size_t count = 0, total = 0;
  for (const size_t size : {0, 1, 2, 31, 33, 64, 65, 1023, 1024, 1025, 3000})
    for (const uint64_t first : {uint64_t{0}, uint64_t{1}, uint64_t{12345678}, uint64_t{7} << 30}) {
      std::vector<uint16_t> p(size);
      for (uint16_t& value : p) {
        value = static_cast<uint16_t>(random.Uniform(0, 65536));
        if (random.Uniform(0, 1) < 0.2) value = random.Uniform(0, 1) < 0.5 ? 0 : 65535;
      }
      std::vector<uint32_t> expected;
      for (uint32_t i = 0; i < size; ++i) {
        const bool is_chosen = chances.Chooses(first + i, p[i]);
        if (is_chosen) expected.push_back(i);
        if (p[i] == 0 || p[i] == 65535) {
          EXPECT_EQ(is_chosen, p[i] != 0);
        }
      }
      chances.Choose(first, p, &chosen);
      EXPECT_EQ(chosen, expected);
      count += chosen.size();
      total += size;
    }
  EXPECT_NEAR(static_cast<double>(count) / static_cast<double>(total), 0.5, 0.02);
}

TEST(RebinImage, APartKeepsWhatTheWholeKeepsThere) {
  const std::vector<uint16_t> table = StoredValueTable({});
  RebinOptions options;
  options.probability = {1, 0.5, 0, 0.1, 0};
  options.averages_others = true;
  for (int variant = 0; variant < 4; ++variant) {
    options.colour_sigma_px = variant < 2 ? 0 : 2.5;
    const BayerPattern bayer = variant % 2 == 0 ? BayerPattern::kNone : BayerPattern::kGrbg;
    const PixelRect rect{20, 15, 57, 48};
    const int around = PixelsAround(options, bayer != BayerPattern::kNone);
    const PixelRect read{rect.x_begin - around, rect.y_begin - around, rect.x_end + around,
                         rect.y_end + around};
    BinnedRays of_whole, of_part;
    RebinImage(TestSlab(), TestCamera(), {5}, NoiseAt({0, 0, 80, 60}, bayer), rect, table, nullptr,
               options, nullptr, RayMap(10), &of_whole);
    RebinImage(TestSlab(), TestCamera(), {5}, NoiseAt(read, bayer), rect, table, nullptr, options,
               nullptr, RayMap(10), &of_part);
    for (size_t shard = 0; shard < RayMap::kShards; ++shard) {
      ASSERT_EQ(of_whole.kept[shard].size(), of_part.kept[shard].size());
      for (size_t i = 0; i < of_whole.kept[shard].size(); ++i) {
        EXPECT_EQ(of_whole.kept[shard][i].cell, of_part.kept[shard][i].cell);
        EXPECT_EQ(of_whole.kept[shard][i].rgb, of_part.kept[shard][i].rgb);
      }
    }
    EXPECT_EQ(CountOf(of_whole.kept) + CountOf(of_whole.others),
              static_cast<size_t>(rect.pixel_count()));
  }
}

// Smoothing reduces the noise of uniform colours, and ignores masked pixels.
TEST(RebinImage, ColoursMayBeSmoothed) {
  const std::vector<uint16_t> table = StoredValueTable({});
  for (const BayerPattern bayer : {BayerPattern::kNone, BayerPattern::kRggb}) {
    LfPixels pixels({0, 0, 80, 60}, bayer);
    RandomSequence random(4);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x)
        for (int c = 0; c < std::min(3, pixels.radiance.channels()); ++c) {
          const int channel = bayer == BayerPattern::kNone ? c : BayerChannel(bayer, x, y);
          pixels.radiance.at(x, y, c) =
              static_cast<uint16_t>(10000 + 9000 * channel + random.Uniform(-3000, 3000));
        }
    for (int c = 0; c < std::min(3, pixels.radiance.channels()); ++c)
      pixels.radiance.at(40, 30, c) = 65535;
    pixels.Mask(40, 30);
    RebinOptions options;
    options.probability.xi = 0.999;
    options.colour_sigma_px = 3;
    BinnedRays rays;
    RebinImage(TestSlab(), TestCamera(), {5}, pixels, {20, 15, 57, 48}, table, nullptr, options,
               nullptr, RayMap(10), &rays);
    EXPECT_GT(CountOf(rays.kept), 1000u);
    for (const auto& shard : rays.kept)
      for (const BinnedRay& ray : shard)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(ray.rgb[c], 10000 + 9000 * c, 1300);
  }
}

// A mosaic of colours that change linearly gives the exact three colours of each pixel.
TEST(RebinImage, MosaicsGiveAllColours) {
  const PixelRect rect{0, 0, 80, 60};
  const auto light = [](int x, int y, int c) {
    return static_cast<uint16_t>(5000 + 200 * c + 300 * x + (100 + 40 * c) * y);
  };
  for (const BayerPattern bayer : {BayerPattern::kRggb, BayerPattern::kGbrg}) {
    LfPixels pixels(rect, bayer);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x)
        pixels.radiance.at(x, y) = light(x, y, BayerChannel(bayer, x, y));
    pixels.Mask(40, 30);
    Slab slab = TestSlab();
    slab.r_uv_w = 1e-4;  // a cell for each pixel
    BinnedRays rays;
    RebinImage(slab, TestCamera(), {0}, pixels, {1, 1, 79, 59}, StoredValueTable({}), nullptr,
               Every(), nullptr, RayMap(10), &rays);
    size_t right = 0, count = 0;
    for (const auto& shard : rays.kept)
      for (const BinnedRay& ray : shard) {
        ++count;
        bool is_light = false;
        for (int y = 1; y < 59 && !is_light; ++y)
          for (int x = 1; x < 79 && !is_light; ++x)
            is_light = std::abs(ray.rgb[0] - light(x, y, 0)) <= 1 &&
                       std::abs(ray.rgb[1] - light(x, y, 1)) <= 1 &&
                       std::abs(ray.rgb[2] - light(x, y, 2)) <= 1;
        right += is_light ? 1 : 0;
      }
    EXPECT_EQ(count, 78u * 58 - 1);
    EXPECT_GE(right, count - 8);  // neighbours of the masked pixel may differ
  }
}

TEST(RebinImage, OthersMakeNoCells) {
  const PixelRect rect{0, 0, 80, 60};
  const std::vector<uint16_t> table = StoredValueTable({});
  RebinOptions options;
  options.probability = {1, 0.2, 0, 0.02, 0};
  Slab slab = TestSlab();
  slab.r_uv_w = 0.02;  // a cell has several pixels
  ThreadPool pool(2);
  const auto cells_of = [&](bool averages, bool reversed) {
    options.averages_others = averages;
    RayMap map(100000);
    std::vector<BinnedRays> rays(4);
    for (uint32_t i = 0; i < 4; ++i)
      RebinImage(slab, TestCamera(), {i}, NoiseAt(rect, BayerPattern::kNone), rect, table, nullptr,
                 options, nullptr, map, &rays[i]);
    if (reversed) std::reverse(rays.begin(), rays.end());
    InsertRays(rays, pool, &map);
    return map.Cells(pool);
  };
  const std::vector<BinnedCell> kept = cells_of(false, false), all = cells_of(true, false);
  ASSERT_EQ(kept.size(), all.size());
  uint64_t rays_kept = 0, rays_all = 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].cell, all[i].cell);
    rays_kept += kept[i].count;
    rays_all += all[i].count;
  }
  EXPECT_GT(rays_all, 3 * rays_kept);
  EXPECT_EQ(cells_of(true, true), all);
}

}  // namespace
}  // namespace lf
